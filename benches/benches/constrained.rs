//! Time per call of forward dynamics of a humanoid of 30 elastic joints, free and on two feet.

use criterion::{Criterion, criterion_group, criterion_main};
use gyroflex::Scalar;
use gyroflex::dynamics::Directions;
use gyroflex::model::Fidelity;
use gyroflex_benches::Standing;
use std::time::Duration;

fn feet<T: Scalar<Param = T> + 'static>(c: &mut Criterion, scalar: &str) {
    for fidelity in [Fidelity::Complete, Fidelity::RigidReflected] {
        for (name, held) in [("free", None), ("points", Some(Directions::POINT)), ("feet", Some(Directions::ALL))] {
            let mut standing = Standing::<T>::new(fidelity, held);
            let mut i = 0;
            c.bench_function(&format!("constrained/{}/{name}/{scalar}", fidelity.name()), |b| {
                b.iter(|| {
                    standing.call(i);
                    i += 1;
                });
            });
        }
    }
}

fn constrained(c: &mut Criterion) {
    feet::<f64>(c, "f64");
    feet::<f32>(c, "f32");
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    targets = constrained
}
criterion_main!(benches);
