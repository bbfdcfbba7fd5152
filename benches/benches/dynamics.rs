//! Time per call of the algorithms on the 7-joint arm `iiwa14`: rigid links alone (7 coordinates) beside the complete model
//! with elastic joints and rotors (14 coordinates), and the other two models.

use criterion::{Criterion, criterion_group, criterion_main};
use gyroflex::model::Fidelity;
use gyroflex_benches::{Workload, robot, without_drives};

type Work = fn(&mut Workload, usize);

fn dynamics(c: &mut Criterion) {
    let arm = robot("iiwa14");
    let plain = without_drives(arm.clone());
    let mut cases = vec![("links alone".to_string(), Workload::new(&plain, Fidelity::Complete))];
    for fidelity in Fidelity::ALL {
        cases.push((fidelity.name().to_string(), Workload::new(&arm, fidelity)));
    }
    let works: [Work; 3] = [Workload::forward, Workload::inverse, Workload::mass_matrix];
    for (name, work) in ["aba", "rnea", "crba"].into_iter().zip(works) {
        let mut group = c.benchmark_group(format!("iiwa14/{name}"));
        for (case, workload) in &mut cases {
            let mut i = 0;
            group.bench_function(case.as_str(), |b| {
                b.iter(|| {
                    work(workload, i);
                    i += 1;
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, dynamics);
criterion_main!(benches);
