//! Cost per link of chains and binary trees: the throughput criterion prints is in links, so an algorithm that costs the same per link
//! at every size shows the same throughput.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use gyroflex::model::Fidelity;
use gyroflex_benches::{Algorithm, Shape, Workload, generated};
use std::time::Duration;

const SIZES: [usize; 6] = [2, 7, 14, 28, 56, 112];

fn links(c: &mut Criterion) {
    for shape in [Shape::Chain, Shape::Tree] {
        for algorithm in Algorithm::ALL {
            for (model, with_drives) in [("links", false), ("complete", true)] {
                let mut group = c.benchmark_group(format!("{}/{}/{model}", shape.name(), algorithm.name()));
                for n in SIZES {
                    let spec = generated(shape, n);
                    let spec = if with_drives { spec } else { spec.without_drives() };
                    let mut workload = Workload::<f64>::new(&spec, Fidelity::Complete);
                    let mut i = 0;
                    group.throughput(Throughput::Elements(n as u64));
                    group.bench_function(n.to_string(), |b| {
                        b.iter(|| {
                            workload.call(algorithm, i);
                            i += 1;
                        });
                    });
                }
                group.finish();
            }
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).warm_up_time(Duration::from_millis(100)).measurement_time(Duration::from_millis(400));
    targets = links
}
criterion_main!(benches);
