//! Functions cut into parts: the parts together are the function.

mod common;

use common::{functions, inputs, seeds};
use gyroflex_codegen::split::{Split, split};

/// Results of the parts, where they belong.
fn assembled(split: &Split, inputs: &[f64], like: &[Vec<f64>]) -> Vec<Vec<Option<f64>>> {
    let mut inputs = inputs.to_vec();
    if let Some(shared) = &split.shared {
        inputs.extend(shared.evaluate(&inputs).remove(0));
    }
    let mut all: Vec<Vec<Option<f64>>> = like.iter().map(|v| vec![None; v.len()]).collect();
    for (part, places) in split.parts.iter().zip(&split.places) {
        let values = part.evaluate(&inputs).remove(0);
        assert_eq!(values.len(), places.len());
        for (value, &(output, entry)) in values.into_iter().zip(places) {
            assert!(all[output][entry].replace(value).is_none(), "{}: entry written twice", part.name);
        }
    }
    all
}

#[test]
fn parts_together_are_the_function_to_the_last_bit() {
    for seed in seeds(30) {
        for function in functions(seed) {
            let x = inputs(&function, seed);
            let whole = function.evaluate(&x);
            for processors in 1..=5 {
                let split = split(&function, processors);
                assert_eq!(split.parts.len(), processors);
                for (part, whole) in assembled(&split, &x, &whole).iter().zip(&whole) {
                    let part: Vec<f64> = part.iter().map(|x| x.expect("every entry is written")).collect();
                    assert_eq!(&part, whole, "seed {seed}, {}, {processors} processors", function.name);
                }
            }
        }
    }
}

#[test]
fn predictions_are_bounded_by_the_work_and_by_the_critical_path() {
    for seed in seeds(30) {
        for function in functions(seed) {
            for processors in 1..=5 {
                let prediction = split(&function, processors).prediction;
                let work = prediction.shared + prediction.parts.iter().sum::<f64>();
                assert!(work >= prediction.whole, "seed {seed}: parts do less than the whole");
                assert!(prediction.ideal_speed_up() <= processors as f64 + 1e-12, "seed {seed}");
                assert!(prediction.parallel() >= prediction.critical_path, "seed {seed}");
                assert!(prediction.speed_up() < prediction.ideal_speed_up(), "seed {seed}");
            }
            let one = split(&function, 1);
            assert!(one.shared.is_none() && one.prediction.parts == [one.prediction.whole], "seed {seed}");
        }
    }
}
