//! Chains and trees of many sizes, for the cost per link. Nobody else computes them, and nothing is expected of them.

use gyroflex::model::Fidelity;
use gyroflex_benches::peers::Worker;
use gyroflex_benches::{Algorithm, Shape, Workload, generated};
use std::cell::RefCell;
use std::rc::Rc;

const SIZES: [usize; 6] = [2, 7, 14, 28, 56, 112];

pub fn add(worker: &mut Worker) {
    for shape in [Shape::Chain, Shape::Tree] {
        for n in SIZES {
            let workload = Workload::<f64>::new(&generated(shape, n), Fidelity::Complete);
            let workload = Rc::new(RefCell::new(workload));
            for algorithm in [Algorithm::Aba, Algorithm::Rnea] {
                let row = format!("{}{n}/{}", shape.name(), algorithm.name());
                worker.add(row, 0.0, &workload, move |w, k| w.call(algorithm, k), |_, _| 0.0);
            }
        }
    }
}
