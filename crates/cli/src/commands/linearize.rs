//! `gyroflex linearize`: a state-space model, printed or written.

use super::{load, output, pose};
use crate::args::Linearize;
use crate::failure::{Failure, print, say, warn};
use crate::json;
use gyroflex_sim::ScenarioFile;
use gyroflex_sim::error::Error;
use gyroflex_sim::linearize::{
    Linearization, Matrices, Output, ReferenceMotion, write_csv, write_mat, zero_order_hold_of,
};
use gyroflex_sim::load::Disk;

pub fn run(args: &Linearize, quiet: bool) -> Result<(), Failure> {
    let outputs = args.output.iter().map(|o| Output::parse(o.trim()));
    let outputs =
        outputs.collect::<Result<Vec<_>, Error>>().map_err(|e| Error { element: "--output".to_owned(), ..e })?;
    let mut series = models(args, &outputs, quiet)?;
    if let Some(step) = args.zoh {
        series = series.iter().map(|l| zero_order_hold_of(l, step)).collect::<Result<_, _>>()?;
    }
    let mut written = Vec::new();
    if let Some(folder) = &args.csv {
        written.extend(write_csv(&series, folder)?);
    }
    if let Some(path) = &args.mat {
        output::spare_the_robot(path, &args.pose.robot)?;
        write_mat(&series, path)?;
        written.push(path.clone());
    }
    if !(written.is_empty() || quiet) {
        let names: Vec<String> = written.iter().map(|p| p.display().to_string()).collect();
        say(&format!("written: {}", names.join(", ")));
    }
    if !(args.json || written.is_empty()) {
        return Ok(());
    }
    let mut models: Vec<Matrices> = series.iter().map(Matrices::from).collect();
    let value = match (&args.scenario, models.pop()) {
        (None, Some(one)) => serde_json::to_value(one),
        (_, last) => serde_json::to_value(models.into_iter().chain(last).collect::<Vec<_>>()),
    };
    print(&json::text(&value.map_err(Error::from)?))
}

/// One model at a pose, or one an instant.
fn models(args: &Linearize, outputs: &[Output], quiet: bool) -> Result<Vec<Linearization>, Failure> {
    let Some(scenario) = &args.scenario else {
        let mut linearizer = pose::linearizer(&args.pose, quiet)?;
        let point = match &args.tau {
            Some(tau) => {
                let tau = pose::torques(&linearizer, tau)?;
                let start = pose::positions(&linearizer, &args.pose)?;
                linearizer.equilibrium_for(&tau, &start).map_err(|e| Error { element: "--tau".to_owned(), ..e })?
            }
            None => pose::equilibrium(&mut linearizer, &args.pose, quiet)?,
        };
        return Ok(vec![linearizer.linearize(&point, outputs)?]);
    };
    let robot = load(&args.pose.robot, args.pose.floating, &args.pose.set, quiet)?;
    let file = ScenarioFile::load(&Disk, scenario)?;
    let fidelity = args.pose.model.map(Into::into);
    let mut motion = ReferenceMotion::new(&robot, &file, fidelity, args.pose.friction.into())?;
    warn(&motion.warnings, quiet);
    let mut series = Vec::with_capacity(args.at.len());
    for &t in &args.at {
        let point = motion.at(t)?;
        series.push(motion.linearizer().linearize(&point, outputs)?);
    }
    Ok(series)
}
