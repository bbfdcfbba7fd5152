//! Throughput of one core with states side by side, in states a second: one state, lanes of `f64`, lanes of `f32`.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use gyroflex::model::Fidelity;
use gyroflex::{Lanes, Scalar};
use gyroflex_benches::{Algorithm, Shape, Workload, generated};
use std::time::Duration;

fn side_by_side<T: Scalar + 'static>(c: &mut Criterion, lanes: usize, name: &str) {
    for algorithm in [Algorithm::Aba, Algorithm::Rnea] {
        let mut group = c.benchmark_group(format!("arm7/{}/complete", algorithm.name()));
        let mut workload = Workload::<T>::new(&generated(Shape::Chain, 7), Fidelity::Complete);
        let mut i = 0;
        group.throughput(Throughput::Elements(lanes as u64));
        group.bench_function(name, |b| {
            b.iter(|| {
                workload.call(algorithm, i);
                i += 1;
            });
        });
        group.finish();
    }
}

fn lanes(c: &mut Criterion) {
    side_by_side::<f64>(c, 1, "f64");
    side_by_side::<Lanes<f64, 8>>(c, 8, "f64x8");
    side_by_side::<Lanes<f32, 16>>(c, 16, "f32x16");
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_millis(400));
    targets = lanes
}
criterion_main!(benches);
