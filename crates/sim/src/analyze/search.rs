//! The largest value of a function over a box: the best of many points, each of the best few pushed uphill.

/// How many of the best points are refined.
const CLIMBERS: usize = 8;
/// First and last step of a refinement, as shares of the box.
const STEPS: [f64; 2] = [0.1, 1e-6];

/// A value and the point it was found at.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    pub(super) value: f64,
    pub(super) at: Vec<f64>,
}

/// Looks for the largest value of `f` over the box, from the given points on, by compass search (Kolda, Lewis, Torczon, *Optimization
/// by direct search*, SIAM Review 2003, algorithm 3.2). Never below the best of the points; the true maximum may be higher.
pub(super) fn largest<E>(
    points: impl Iterator<Item = Vec<f64>>,
    bounds: &[[f64; 2]],
    f: &mut dyn FnMut(&[f64]) -> Result<f64, E>,
) -> Result<Option<Found>, E> {
    let mut best: Vec<Found> = Vec::new();
    for at in points {
        let value = f(&at)?;
        if best.len() < CLIMBERS || best.last().is_some_and(|worst| value > worst.value) {
            let place = best.partition_point(|b| b.value >= value);
            best.insert(place, Found { value, at });
            best.truncate(CLIMBERS);
        }
    }
    for found in &mut best {
        climb(found, bounds, f)?;
    }
    Ok(best.into_iter().max_by(|a, b| a.value.total_cmp(&b.value)))
}

/// Steps along one coordinate at a time while that leads uphill, else halves the step.
fn climb<E>(found: &mut Found, bounds: &[[f64; 2]], f: &mut dyn FnMut(&[f64]) -> Result<f64, E>) -> Result<(), E> {
    let mut step = STEPS[0];
    while step > STEPS[1] {
        let mut better = false;
        for (k, [low, high]) in bounds.iter().enumerate() {
            for way in [step, -step] {
                let mut at = found.at.clone();
                at[k] = (at[k] + way * (high - low)).clamp(*low, *high);
                let value = f(&at)?;
                if value > found.value {
                    *found = Found { value, at };
                    better = true;
                    break;
                }
            }
        }
        if !better {
            step *= 0.5;
        }
    }
    Ok(())
}
