//! Prints the walks of Mu & Wu (2004) beside the paper's statements, and draws `docs/mu2004.svg`.
//!
//!     cargo run --release -p gyroflex-tests --example mu2004

mod figure;
mod study;

use std::error::Error;
use std::path::Path;
use study::{Study, walk};

fn main() -> Result<(), Box<dyn Error>> {
    let same = |text: String| text;
    let ideal = walk("biped5/walk.yaml", same)?;
    let known = walk("biped5/walk.yaml", |text| text.replace("believes: {mass: 1.4, length: 1.1}", ""))?;
    let plain = |text: String| text.replace("rear_share: [0.5, 0.1]", "rear_share: [0, 0]");
    let front = walk("biped5/walk.yaml", plain)?;
    let elastic = walk("biped5_elastic/walk.yaml", same)?;
    let geared = |text: String| text.replace("robot: robot.yaml", "robot: robot.yaml\nmodel: rigid");
    let rigid = walk("biped5_elastic/walk.yaml", geared)?;

    println!("| | steps | speed [m/s] | footprints off by [mm] | impulse of a landing [N s]: ahead, up | drift [m] |");
    println!("|---|---|---|---|---|---|");
    let all = [
        ("paper's robot, wrong model", &ideal),
        ("the same, model known", &known),
        ("the same, no load left to the rear foot", &front),
        ("rotors, rigid gears", &rigid),
        ("rotors, elastic gears", &elastic),
    ];
    for (name, study) in all {
        let last = study.landings().last().ok_or("it never lands")?;
        let [ahead, _, up] = last.impulse;
        println!(
            "| {name} | {} | {:.4} | {:.2} | {ahead:.4}, {up:.4} | {:.0e} |",
            study.landings().count(),
            study.speed(),
            1e3 * study.foot_placing(),
            study.drift
        );
    }
    for (phase, both) in [("one foot", false), ("both feet", true)] {
        println!("\nOn {phase}:\n");
        println!(
            "| | hip ahead, up [mm] | trunk [deg] | least vertical force: front, rear [N] | friction: front, rear | largest joint torque [N m] |"
        );
        println!("|---|---|---|---|---|---|");
        for (name, study) in all {
            println!("| {name} {}", row(study, both));
        }
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/mu2004.svg");
    std::fs::write(&file, figure::svg(&ideal, &elastic)?)?;
    Ok(())
}

fn row(study: &Study, both: bool) -> String {
    let f = study.figures(both);
    let of = |v: [f64; 2], digits: usize| match both {
        true => format!("{:.digits$}, {:.digits$}", v[0], v[1]),
        false => format!("{:.digits$}", v[0]),
    };
    let [x, z, trunk] = f.errors;
    format!(
        "| {:.2}, {:.2} | {:.3} | {} | {} | {:.0} |",
        1e3 * x,
        1e3 * z,
        trunk.to_degrees(),
        of(f.vertical, 0),
        of(f.friction, 2),
        f.torque
    )
}
