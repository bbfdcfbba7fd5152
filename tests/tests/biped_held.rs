//! Constraints and impacts on the planar five-link biped against the closed forms of Mu and Wu (2004); equation numbers are theirs.

use gyroflex::dynamics::{Anchor, Constraint, Directions, Frame, Hold};
use gyroflex::model::{Fidelity, RobotSpec};
use gyroflex::spatial::{Transform, Vec3};
use gyroflex_testkit::State as Point;
use gyroflex_testkit::biped::{
    Biped, Links, Planar, Stance, TrunkRooted, joint_rates, segment_angles, segment_rates, segment_torques,
};
use gyroflex_testkit::random::random_point;
use gyroflex_testkit::tolerance::{assert_close, assert_close_above, norm};
use gyroflex_tests::{Core, Held};

const SEEDS: u64 = 1000;
const BIPED: Biped = Biped::MU_WU;

/// A point of a link held where it is, in the plane.
fn held(body: usize, point: Vec3<f64>, at: Planar) -> Constraint<f64> {
    let frame = Frame { body, placement: Transform { pos: point, ..Transform::identity() } };
    let place = Transform { pos: Vec3::new(at[0], 0.0, at[1]), ..Transform::identity() };
    let hold =
        Hold::Frame { frame, anchor: Anchor { body: None, placement: place }, directions: Directions::PLANAR_POINT };
    Constraint { hold, stabilisation: 0.0, contact: None }
}

/// The chain on the pinned tip, and the tip `e` held where it is; states are left out where the legs are nearly in line.
fn for_double_support(law: impl Fn(&str, &Core<f64>, &Point, &Held, &Links, &Links)) {
    let bodies = BIPED.pinned_chain();
    let spec = RobotSpec { bodies: &bodies, spring_tables: &[], gravity: BIPED.chain_gravity() };
    let core = Core::<f64>::new(&spec, Fidelity::Complete);
    let mut shown = 0;
    for seed in 0..SEEDS {
        let mut s = Point { tau_ext: Vec::new(), wrenches: Vec::new(), ..random_point(&bodies, &[], seed) };
        let theta = segment_angles(&Links::from_column_slice(&s.q));
        let tip = BIPED.joint(5, &theta.into());
        let held = Held::new(vec![held(4, Vec3::new(0.0, 0.0, BIPED.length[4]), Planar::new(tip[0], tip[1]))]);
        if core.constrained(&s, &held).solved.independence < 1e-3 {
            continue;
        }
        shown += 1;
        let rate = segment_rates(&Links::from_column_slice(&s.qd));
        let standing = BIPED.standing_rate(&theta, &rate);
        law(&format!("seed {seed}, before"), &core, &s, &held, &theta, &rate);
        s.qd = joint_rates(&standing).as_slice().to_vec();
        law(&format!("seed {seed}, standing"), &core, &s, &held, &theta, &standing);
    }
    assert!(shown > SEEDS * 9 / 10, "only {shown} states have their legs out of line");
}

#[test]
fn double_support_accelerates_and_is_held_as_in_equation_7() {
    for_double_support(|context, core, s, held, theta, rate| {
        let torque = segment_torques(&Links::from_column_slice(&s.tau));
        let (got, want) = (core.constrained(s, held), BIPED.double_support(theta, rate, &torque));
        assert_close("accelerations", &context, &got.links, joint_rates(&want.acceleration).as_slice(), 1e-9);
        assert_close_above("multipliers", &context, &got.multipliers, want.force.as_slice(), 1e-9, 1.0);
    });
}

/// Of the same motion, without the forces of the ground in the equations (eq. 19).
#[test]
fn hip_and_trunk_accelerate_as_in_equation_19() {
    for_double_support(|context, core, s, held, theta, rate| {
        if context.ends_with("before") || theta[0].sin().abs().min((theta[0] - theta[1]).sin().abs()) < 0.1 {
            return;
        }
        let torque = segment_torques(&Links::from_column_slice(&s.tau));
        let acceleration = segment_rates(&Links::from_column_slice(&core.constrained(s, held).links));
        let outputs = BIPED.outputs(theta, rate);
        let got = outputs.jacobian * acceleration + outputs.jacobian_rate * rate;
        let form = BIPED.reduced_form(theta, rate);
        let want = form.rate_matrix * outputs.jacobian * rate + form.torque_matrix * (torque - BIPED.bias(theta, rate));
        let size = norm(acceleration.as_slice());
        assert_close_above("outputs", &context, got.as_slice(), want.as_slice(), 1e-9, size);
    });
}

#[test]
fn double_impact_is_that_of_equation_21() {
    for_double_support(|context, core, s, held, theta, rate| {
        let (got, want) = (core.impact(s, held), BIPED.double_impact(theta, rate));
        let before = norm(&s.qd);
        assert_close_above("velocities", &context, &got.links, joint_rates(&want.rate).as_slice(), 1e-10, before);
        assert_close_above("impulse", &context, &got.multipliers, want.landing.as_slice(), 1e-10, 1.0);
        let lost = BIPED.kinetic(theta, rate) - BIPED.kinetic(theta, &want.rate);
        assert!(lost >= -1e-10 * BIPED.kinetic(theta, rate), "kinetic energy grows by {} J; {context}", -lost);
    });
}

/// The robot of the files on both feet: its tree begins at the trunk, and no foot is special.
#[test]
fn the_robot_on_both_feet_moves_as_the_chain() {
    let path = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots/biped5/robot.yaml");
    let robot = gyroflex_sim::load::load(&path, &gyroflex_sim::load::LoadOptions::default()).expect("it loads");
    let core = Core::<f64>::new(&robot.spec(), Fidelity::Complete);
    for_double_support(|context, _, s, _, theta, rate| {
        for (stance, shanks) in [(Stance::Left, [4, 6]), (Stance::Right, [6, 4])] {
            let tip = BIPED.joint(5, &(*theta).into());
            let sole = Vec3::new(0.0, 0.0, -BIPED.length[0]);
            let feet = Held::new(vec![
                held(shanks[0], sole, Planar::zeros()),
                held(shanks[1], sole, Planar::new(tip[0], tip[1])),
            ]);
            let joint = Links::from_column_slice(&s.tau);
            // The ankle's torque is a couple on the standing shank.
            let mut wrenches = vec![[0.0; 6]; 7];
            wrenches[shanks[0]][1] = joint[0];
            let state = Point {
                q: TrunkRooted::from_angles(&BIPED, stance, theta, &Planar::zeros()).0.to_vec(),
                qd: TrunkRooted::from_rates(&BIPED, stance, theta, rate).0.to_vec(),
                theta: vec![0.0; 7],
                thetad: vec![0.0; 7],
                tau: TrunkRooted::from_joint_torques(stance, &joint).0.to_vec(),
                wrenches,
                ..Point::default()
            };
            let want = BIPED.double_support(theta, rate, &segment_torques(&joint));
            let got = core.constrained(&state, &feet);
            let moved = TrunkRooted::from_accelerations(&BIPED, stance, theta, rate, &want.acceleration);
            assert_close("accelerations", &context, &got.links, &moved.0, 1e-9);
            assert_close_above("front foot", &context, &got.multipliers[2..], want.force.as_slice(), 1e-9, 1.0);
            let impact = BIPED.double_impact(theta, rate);
            let caught = core.impact(&state, &feet);
            let after = TrunkRooted::from_rates(&BIPED, stance, theta, &impact.rate);
            let before = norm(&state.qd).max(norm(&after.0));
            assert_close_above("velocities", &context, &caught.links, &after.0, 1e-10, before);
            let impulses = [impact.standing.as_slice(), impact.landing.as_slice()].concat();
            assert_close_above("impulses", &context, &caught.multipliers, &impulses, 1e-10, norm(&impulses).max(1.0));
        }
    });
}
