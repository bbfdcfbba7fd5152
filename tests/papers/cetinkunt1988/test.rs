//! Laws of the case study of Cetinkunt & Book (1988).

mod study;

use study::{BOUNDARIES, response};

#[test]
fn stiffer_links_approach_the_rigid_arm_and_clamped_tips_faster() {
    let rigid = response(None).expect("the rigid arm moves");
    let mut before: Option<[[f64; 2]; 2]> = None;
    for stiffness in [100.0, 1e3] {
        let errors = BOUNDARIES.map(|boundary| {
            let run = response(Some((stiffness, boundary))).expect("the flexible arm moves");
            // What the trapezoids of the work miss shrinks with the step, the balance itself is exact.
            assert!(run.balance < 1e-6, "the energy balance is open by {}", run.balance);
            run.from(&rigid)
        });
        for j in 0..2 {
            assert!(
                errors[1][j] < 0.3 * errors[0][j],
                "clamped-clamped {} is not closer than clamped-free {}",
                errors[1][j],
                errors[0][j]
            );
        }
        if let Some(before) = before {
            // Deflections under the same torques go with 1/EI.
            for (was, is) in before.iter().flatten().zip(errors.iter().flatten()) {
                assert!((7.0..14.0).contains(&(was / is)), "ten times the stiffness changes {was} to {is}");
            }
        }
        before = Some(errors);
    }
}
