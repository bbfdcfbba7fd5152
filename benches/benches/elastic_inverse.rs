//! Time per call of the elastic inverse of a seven-joint arm with successive perpendicular axes, by the derivatives of the motion that
//! it needs.

use criterion::{Criterion, criterion_group, criterion_main};
use gyroflex::Scalar;
use gyroflex::model::Fidelity;
use gyroflex_benches::{Algorithm, Shape, Workload, generated};
use std::time::Duration;

fn over_models<T: Scalar<Param = T> + 'static>(c: &mut Criterion, scalar: &str) {
    let arm = generated(Shape::Chain, 7);
    for (name, spec) in [("damped", arm.clone()), ("undamped", arm.undamped())] {
        for fidelity in [Fidelity::Complete, Fidelity::Reduced] {
            let mut workload = Workload::<T>::new(&spec, fidelity);
            let order = workload.order();
            let mut i = 0;
            c.bench_function(&format!("elastic_inverse/{}/{name}/order {order}/{scalar}", fidelity.name()), |b| {
                b.iter(|| {
                    workload.call(Algorithm::ElasticInverse, i);
                    i += 1;
                });
            });
        }
    }
}

fn elastic_inverse(c: &mut Criterion) {
    over_models::<f64>(c, "f64");
    over_models::<f32>(c, "f32");
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(1));
    targets = elastic_inverse
}
criterion_main!(benches);
