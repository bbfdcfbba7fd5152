//! Prints how the flexible two-link arm of Cetinkunt & Book (1988) approaches the rigid one, and draws `docs/cetinkunt1988.svg`.
//!
//!     cargo run --release -p gyroflex-tests --example cetinkunt1988

mod figure;
mod study;

use std::error::Error;
use std::path::Path;
use study::{BOUNDARIES, Response, response};

/// Bending stiffness of both links [N m²]; the paper has the first two.
const STIFFNESSES: [f64; 5] = [10.0, 100.0, 1e3, 1e4, 1e5];

fn main() -> Result<(), Box<dyn Error>> {
    let rigid = response(None)?;
    let mut drawn: Vec<(String, Response)> = Vec::new();
    println!("| EI [N m²] | clamped-free: joint 1, 2 [mrad] | clamped-clamped: joint 1, 2 [mrad] | energy balance |");
    println!("|---|---|---|---|");
    for stiffness in STIFFNESSES {
        let mut cells = Vec::new();
        let mut balance = 0.0_f64;
        for boundary in BOUNDARIES {
            let run = response(Some((stiffness, boundary)))?;
            let [first, second] = run.from(&rigid).map(|x| 1e3 * x);
            cells.push(format!("{first:.3}, {second:.3}"));
            balance = balance.max(run.balance);
            if stiffness <= 100.0 {
                drawn.push((format!("{}, EI = {stiffness} N m²", boundary.replace('_', "-")), run));
            }
        }
        println!("| {stiffness:e} | {} | {balance:.0e} |", cells.join(" | "));
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/cetinkunt1988.svg");
    std::fs::write(&file, figure::svg(&rigid, &drawn)?)?;
    Ok(())
}
