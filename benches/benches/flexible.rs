//! Time per call of forward dynamics of arms whose links bend: the two-link arm, with and without elastic joints, and how the cost
//! grows with links and with modes.

use criterion::{Criterion, criterion_group, criterion_main};
use gyroflex::Scalar;
use gyroflex_benches::{Beams, FlexibleAlgorithm};
use std::time::Duration;

fn arm<T: Scalar<Param = T> + 'static>(
    c: &mut Criterion,
    (links, modes, elastic): (usize, usize, bool),
    algorithm: FlexibleAlgorithm,
    scalar: &str,
) {
    let mut arm = Beams::<T>::new(links, modes, elastic);
    let joints = if elastic { "elastic" } else { "rigid" };
    let name = algorithm.name();
    let mut i = 0;
    c.bench_function(&format!("flexible/{name}/{links} links/{modes} modes each/{joints} joints/{scalar}"), |b| {
        b.iter(|| {
            arm.call(algorithm, i);
            i += 1;
        });
    });
}

fn flexible(c: &mut Criterion) {
    for elastic in [false, true] {
        arm::<f64>(c, (2, 2, elastic), FlexibleAlgorithm::Forward, "f64");
        arm::<f32>(c, (2, 2, elastic), FlexibleAlgorithm::Forward, "f32");
    }
    for algorithm in [FlexibleAlgorithm::Inverse, FlexibleAlgorithm::Hybrid] {
        arm::<f64>(c, (2, 2, false), algorithm, "f64");
    }
    for modes in [0, 1, 2, 4, 8] {
        arm::<f64>(c, (2, modes, true), FlexibleAlgorithm::Forward, "f64");
    }
    for links in [1, 2, 4, 8, 15, 30] {
        arm::<f64>(c, (links, 2, true), FlexibleAlgorithm::Forward, "f64");
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    targets = flexible
}
criterion_main!(benches);
