//! Runs single calls between marks, for `benches/instructions`, which steps through them and counts.
//!
//! The first line says where [`mark`] is; then the program waits for a line on standard input. Before and after every counted
//! call it passes the mark, and then names the case.

use gyroflex::Scalar;
use gyroflex::dynamics::Directions;
use gyroflex::model::Fidelity;
use gyroflex_benches::{Algorithm, Shape, Spec, Standing, Workload, generated};
use std::hint::black_box;
use std::io::Write;

/// Where counting begins and ends.
#[inline(never)]
fn mark() {
    black_box(());
}

/// Counts every algorithm at the first `states` random states.
fn cases<T: Scalar<Param = T> + 'static>(robot: &str, spec: &Spec, fidelity: Fidelity, scalar: &str, states: usize) {
    let mut workload = Workload::<T>::new(spec, fidelity);
    for algorithm in Algorithm::ALL.into_iter().filter(|a| *a != Algorithm::ElasticInverse) {
        // They are the same source for all scalars and models, and long to step through.
        if algorithm.is_derivative() && (fidelity != Fidelity::Complete || scalar == "f32" || robot == "tree14") {
            continue;
        }
        let states = if algorithm.is_derivative() { states.min(2) } else { states };
        // What is done once and for all, like asking the processor what it can, is not a call's cost.
        workload.call(algorithm, 0);
        for i in 0..states {
            mark();
            workload.call(algorithm, i);
            mark();
            println!("{robot} {} {} {scalar}", algorithm.name(), fidelity.name());
        }
    }
}

/// Counts the elastic inverse of an arm.
fn elastic_inverse<T: Scalar<Param = T> + 'static>(robot: &str, spec: &Spec, scalar: &str) {
    for fidelity in [Fidelity::Complete, Fidelity::Reduced] {
        let mut workload = Workload::<T>::new(spec, fidelity);
        workload.call(Algorithm::ElasticInverse, 0);
        for i in 0..2 {
            mark();
            workload.call(Algorithm::ElasticInverse, i);
            mark();
            println!("{robot} elastic_inverse{} {} {scalar}", workload.order(), fidelity.name());
        }
    }
}

/// Counts forward dynamics of a humanoid on two feet.
fn constrained<T: Scalar<Param = T> + 'static>(scalar: &str) {
    for (name, held) in [("points", Directions::POINT), ("feet", Directions::ALL)] {
        let mut standing = Standing::<T>::new(Fidelity::Complete, Some(held));
        standing.call(0);
        for i in 0..2 {
            mark();
            standing.call(i);
            mark();
            println!("humanoid30 constrained_{name} complete {scalar}");
        }
    }
}

fn main() -> std::io::Result<()> {
    println!("{:p}", mark as *const ());
    std::io::stdout().flush()?;
    std::io::stdin().read_line(&mut String::new())?;
    mark();
    mark();
    println!("nothing");
    let arm = generated(Shape::Chain, 7);
    // Every step costs, so that one case stands for the others in showing that the count does not depend on the state.
    cases::<f64>("arm7", &arm, Fidelity::Complete, "f64", 6);
    for fidelity in [Fidelity::Reduced, Fidelity::Rigid, Fidelity::RigidReflected] {
        cases::<f64>("arm7", &arm, fidelity, "f64", 2);
    }
    cases::<f32>("arm7", &arm, Fidelity::Complete, "f32", 2);
    for spec in [arm.clone(), arm.undamped()] {
        elastic_inverse::<f64>("arm7", &spec, "f64");
        elastic_inverse::<f32>("arm7", &spec, "f32");
    }
    constrained::<f64>("f64");
    cases::<f64>("tree14", &generated(Shape::Tree, 14), Fidelity::Complete, "f64", 2);
    Ok(())
}
