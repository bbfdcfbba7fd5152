//! Runs one algorithm on `iiwa14` a given number of times and does nothing else, for a tool that counts instructions.
//! Usage: `instructions CASE CALLS`, CASE one of `aba:links`, `aba:complete`, `rnea:links`, `rnea:complete`, `crba:links`, …

use gyroflex::model::Fidelity;
use gyroflex_benches::{Workload, robot, without_drives};

fn main() {
    let mut args = std::env::args().skip(1);
    let case = args.next().unwrap_or_default();
    let calls: usize = args.next().and_then(|n| n.parse().ok()).unwrap_or(0);
    let (algorithm, model) = case.split_once(':').unwrap_or((&case, "complete"));
    let arm = robot("iiwa14");
    let mut workload = match Fidelity::ALL.iter().find(|f| f.name() == model) {
        Some(fidelity) => Workload::new(&arm, *fidelity),
        None => Workload::new(&without_drives(arm), Fidelity::Complete),
    };
    let work = match algorithm {
        "aba" => Workload::forward,
        "rnea" => Workload::inverse,
        _ => Workload::mass_matrix,
    };
    for i in 0..calls {
        work(&mut workload, i);
    }
}
