//! Batches over the cores: states a second of the whole machine, with one thread, two, four, ... up to its cores.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use gyroflex::model::Fidelity;
use gyroflex_sim::batch::{Algorithm, Given, evaluate};
use gyroflex_sim::load::{LoadOptions, load};
use rayon::ThreadPoolBuilder;
use std::{path::Path, thread, time::Duration};

const STATES: usize = 16_384;

fn batch(c: &mut Criterion) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/iiwa14/robot.yaml");
    let robot = load(&file, &LoadOptions::default()).expect("a robot of this repository loads");
    let model = robot.model(Fidelity::Complete).expect("it has a complete model");
    let length = STATES * model.view().nv();
    // Points of a golden-ratio sequence cover the interval evenly.
    let numbers = |first: usize| -> Vec<f64> {
        (first..first + length).map(|i| 2.0 * (i as f64 * 0.618_033_988_749_894_9).fract() - 1.0).collect()
    };
    let [q, qd, theta, thetad, tau] = [0, 1, 2, 3, 4].map(|i| numbers(i * length));
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; length]);

    let mut group = c.benchmark_group("iiwa14/aba/complete/batch");
    group.throughput(Throughput::Elements(STATES as u64)).sampling_mode(SamplingMode::Flat);
    let cores = thread::available_parallelism().map_or(1, usize::from);
    for threads in (0..).map(|i| 1 << i).take_while(|&threads| threads <= cores) {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("the system gives threads");
        group.bench_function(format!("{threads} threads"), |b| {
            b.iter(|| {
                pool.install(|| {
                    let given = Given { q: &q, qd: &qd, theta: &theta, thetad: &thetad, tau: &tau, ..Given::default() };
                    let out = &mut [&mut qdd[..], &mut thetadd, &mut tau_j];
                    evaluate(&model, &Algorithm::ForwardDynamics, STATES, given, out)
                })
                .expect("all have the length of the batch");
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(50).warm_up_time(Duration::from_millis(200)).measurement_time(Duration::from_secs(2));
    targets = batch
}
criterion_main!(benches);
