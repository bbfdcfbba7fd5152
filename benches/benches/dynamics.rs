//! Time per call over robots, algorithms, models and scalars. `links` is the robot without drives: its plain rigid dynamics
//! (7 coordinates of `iiwa14`) beside the complete model with elastic joints and rotors (14).
//!
//! One of them: `cargo bench -p gyroflex-benches --bench dynamics -- iiwa14/aba/complete`.

use criterion::{Criterion, criterion_group, criterion_main};
use gyroflex::Scalar;
use gyroflex::model::Fidelity;
use gyroflex_benches::{Algorithm, Spec, Workload, robot};
use std::time::Duration;

fn over_models<T: Scalar<Param = T> + 'static>(c: &mut Criterion, name: &str, spec: &Spec, scalar: &str) {
    let mut models = vec![("links", Workload::<T>::new(&spec.clone().without_drives(), Fidelity::Complete))];
    models.extend(Fidelity::ALL.map(|fidelity| (fidelity.name(), Workload::new(spec, fidelity))));
    for algorithm in Algorithm::ALL {
        for (model, workload) in models.iter_mut().filter(|(_, workload)| workload.takes(algorithm)) {
            let mut i = 0;
            c.bench_function(&format!("{name}/{}/{model}/{scalar}", algorithm.name()), |b| {
                b.iter(|| {
                    workload.call(algorithm, i);
                    i += 1;
                });
            });
        }
    }
}

fn dynamics(c: &mut Criterion) {
    for name in ["iiwa14", "puma560", "manutec_r3"] {
        let spec = robot(name);
        over_models::<f64>(c, name, &spec, "f64");
        over_models::<f32>(c, name, &spec, "f32");
    }
}

criterion_group! {
    name = benches;
    // 180 benches: two minutes and a half in all.
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_millis(400));
    targets = dynamics
}
criterion_main!(benches);
