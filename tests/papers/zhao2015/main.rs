//! Prints the comparison of Zhao et al. 2015 and where its effect becomes visible, and draws `docs/zhao2015.svg`.
//!
//!     cargo run --release -p gyroflex-tests --example zhao2015

mod figure;
mod study;

use std::error::Error;
use std::path::Path;
use study::{Comparison, Conditions, compare};

fn main() -> Result<(), Box<dyn Error>> {
    println!("| simulator | largest tool error [mm] | rms [mm] |");
    println!("|---|---|---|");
    let base = compare(Conditions::default())?;
    for (i, name) in ["complete", "reduced"].into_iter().enumerate() {
        println!("| {name} | {:.5} | {:.5} |", 1e3 * base.max(i), 1e3 * base.rms(i));
    }
    println!(
        "\nLargest |r_s| along the run: {:.4}; largest joint speed {:.0} deg/s.",
        base.largest_ratio(),
        base.speed.to_degrees()
    );

    println!(
        "\n| pace | gear ratios | link masses | largest joint speed [deg/s] | complete [mm] | reduced [mm] | largest abs. r_s |"
    );
    println!("|---|---|---|---|---|---|---|");
    let factors = [
        (1.0, 1.0, 1.0),
        (2.0, 1.0, 1.0),
        (2.9, 1.0, 1.0),
        (1.0, 0.5, 1.0),
        (1.0, 2.0, 1.0),
        (1.0, 3.0, 1.0),
        (1.0, 1.0, 0.5),
        (1.0, 1.0, 0.2),
        (1.0, 2.0, 0.2),
        (2.9, 2.0, 0.2),
    ];
    for (pace, gears, links) in factors {
        let head = format!("| {pace} | × {gears} | × {links} |");
        match compare(Conditions { pace, gears, links, ..Conditions::default() }) {
            Ok(c) => println!("{head} {}", row(&c)),
            Err(e) => println!("{head} {e} |"),
        }
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/zhao2015.svg");
    std::fs::write(&file, figure::svg(&base)?)?;
    Ok(())
}

fn row(c: &Comparison) -> String {
    let (complete, reduced) = (1e3 * c.max(0), 1e3 * c.max(1));
    format!("{:.0} | {complete:.4} | {reduced:.5} | {:.3} |", c.speed.to_degrees(), c.largest_ratio())
}
