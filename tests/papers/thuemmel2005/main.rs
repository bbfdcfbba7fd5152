//! Prints what Thümmel, Otter & Bals found of the inverse dynamics of a lightweight arm, as it comes out for `robots/lwr`, and draws
//! `docs/thuemmel2005.svg`.
//!
//!     cargo run --release -p gyroflex-tests --example thuemmel2005

mod arm;
mod figure;
mod following;
mod positioning;
mod square;
mod torques;

use arm::N;
use following::{Conditions, LAWS, Run, follow};
use square::Square;
use std::error::Error;
use std::path::Path;
use torques::{CUTOFFS, Size, Torques, orders};

/// The robot that the controller knows, the same under a faster controller, and one with softer springs.
const CASES: [Conditions; 3] = [
    Conditions { springs: 1.0, rate: 1e3 },
    Conditions { springs: 1.0, rate: 1e4 },
    Conditions { springs: 0.8, rate: 1e3 },
];

fn main() -> Result<(), Box<dyn Error>> {
    table_1()?;
    let bare = figure_6("no load", "robot.yaml", CUTOFFS[0])?;
    figure_6("8 kg", "loaded.yaml", CUTOFFS[0])?;
    figure_6("no load", "robot.yaml", CUTOFFS[1])?;
    figure_6("8 kg", "loaded.yaml", CUTOFFS[1])?;
    let positioning = positioning()?;
    let (square, tracking) = tracking()?;
    let content = figure::Content { torques: &bare, positioning: &positioning, square: &square, tracking: &tracking };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/thuemmel2005.svg");
    std::fs::write(&file, figure::svg(&content)?)?;
    Ok(())
}

fn table_1() -> Result<(), Box<dyn Error>> {
    println!("| transmissions | order of derivatives of | complete | reduced |");
    println!("|---|---|---|---|");
    for (name, file) in [("damped", "robot.yaml"), ("undamped", "undamped.yaml")] {
        let [complete, reduced] = orders(file)?;
        println!("| {name} | the equations of motion | {} | {} |", complete - 2, reduced - 2);
        println!("| {name} | q(t) | {complete} | {reduced} |");
    }
    Ok(())
}

fn figure_6(load: &str, robot: &str, cutoff: f64) -> Result<Torques, Box<dyn Error>> {
    let torques = Torques::along_step(robot, cutoff)?;
    println!("\nStep filtered at {cutoff} Hz, {load}:\n");
    println!(
        "| joint | peak torque [N m] | reduced: peak error [N m] | rms [N m] | rigid: peak error [N m] | rms [N m] | rigid, reflected: peak error [N m] | rms [N m] |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let one = (0..N).map(|j| ((j + 1).to_string(), j..j + 1));
    for (name, joints) in one.chain([("all".to_owned(), 0..N)]) {
        let torque = torques.torque(joints.clone());
        let cell = |model: usize| {
            let error = torques.error(model, joints.clone());
            let share = |part: f64, whole: f64| 100.0 * part / whole;
            let (peak, rms) = (share(error.peak, torque.peak), share(error.rms, torque.rms));
            format!("{:.3} ({peak:.2} %) | {:.3} ({rms:.2} %)", error.peak, error.rms)
        };
        println!("| {name} | {:.1} | {} | {} | {} |", torque.peak, cell(1), cell(2), cell(3));
    }
    Ok(torques)
}

fn positioning() -> Result<Vec<Run>, Box<dyn Error>> {
    let motion = positioning::motion()?;
    println!(
        "\n| springs | rate [kHz] | controller | peak residual [mm] | factor | within 0.1 mm after [s] | largest share of torque | of velocity |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let mut nominal = Vec::new();
    for (case, conditions) in CASES.into_iter().enumerate() {
        let (springs, rate, mut first) = (format!("× {}", conditions.springs), 1e-3 * conditions.rate, None);
        for (law, (name, _)) in LAWS.iter().enumerate() {
            let run = follow(law, &motion, conditions)?;
            let residual = positioning::residual(&run);
            let peak = 1e3 * Size::of(residual.iter().map(|r| r.1)).peak;
            let factor = *first.get_or_insert(peak) / peak;
            println!(
                "| {springs} | {rate} | {name} | {peak:.4} | {factor:.1} | {:.3} | {:.2} | {:.2} |",
                positioning::settling(&residual, 1e-4),
                run.effort,
                run.haste
            );
            if case == 0 {
                nominal.push(run);
            }
        }
    }
    Ok(nominal)
}

fn tracking() -> Result<(Square, Vec<Run>), Box<dyn Error>> {
    let square = Square::new()?;
    println!(
        "\n| springs | rate [kHz] | controller | from the path: rms [mm] | peak [mm] | factor of rms | of peak | from the reference: rms [mm] | peak [mm] | largest share of torque | of velocity |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let mut nominal = Vec::new();
    for (case, conditions) in CASES.into_iter().enumerate() {
        let (springs, rate, mut first) = (format!("× {}", conditions.springs), 1e-3 * conditions.rate, None);
        for (law, (name, _)) in LAWS.iter().enumerate() {
            let run = follow(law, &square.motion, conditions)?;
            let off = Size::of(run.tip.iter().map(|p| 1e3 * square.distance(*p)));
            let late = Size::of(run.tip.iter().zip(&run.wanted).map(|(a, b)| 1e3 * (*a - *b).norm()));
            let alone = *first.get_or_insert(off);
            println!(
                "| {springs} | {rate} | {name} | {:.4} | {:.4} | {:.1} | {:.1} | {:.4} | {:.4} | {:.2} | {:.2} |",
                off.rms,
                off.peak,
                alone.rms / off.rms,
                alone.peak / off.peak,
                late.rms,
                late.peak,
                run.effort,
                run.haste
            );
            if case == 0 {
                nominal.push(run);
            }
        }
    }
    let reference = Size::of(nominal[0].wanted.iter().map(|p| 1e3 * square.distance(*p)));
    println!("\nThe reference itself leaves the path by at most {:.0e} mm.", reference.peak);
    Ok((square, nominal))
}
