//! Several states side by side: the laws of one state hold, and every lane is the state computed alone.

use gyroflex::Lanes;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, CrbaScratch, External, Forward, Inverse, RneaScratch, State, aba, crba, placements, rnea,
};
use gyroflex::model::Fidelity;
use gyroflex::spatial::Transform;
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::tolerance::{norm, relative_error, tol};
use gyroflex_testkit::{Lowered, State as Point};
use gyroflex_tests::{Core, for_trials};

type Eight = Lanes<f64, 8>;

#[test]
fn lanes_equal_the_dense_oracles() {
    for_trials::<Eight>(200, &Options::default(), &Fidelity::ALL, tol(1e-10, 0.0), |t| {
        let (got, want) = (t.core.forward(&t.state), t.oracle().forward(&t.state));
        t.assert_close("qdd", &got.qdd, &want.qdd, 0.0);
        t.assert_close("thetadd", &got.thetadd, &want.thetadd, 0.0);
        let (got, want) = (t.core.inverse(&t.state), t.oracle().inverse(&t.state));
        t.assert_close("tau", &got.tau, &want.tau, norm(&want.tau_j));
        t.assert_close("tau_j", &got.tau_j, &want.tau_j, 0.0);
    });
}

/// One entry of each of eight states, lane by lane.
fn gather(points: &[Point; 8], field: impl Fn(&Point) -> &[f64]) -> Vec<Eight> {
    (0..field(&points[0]).len()).map(|k| Lanes(core::array::from_fn(|lane| field(&points[lane])[k]))).collect()
}

fn lane(values: &[Eight], lane: usize) -> Vec<f64> {
    values.iter().map(|x| x.0[lane]).collect()
}

#[test]
fn each_lane_equals_its_state_alone() {
    for seed in 0..200 {
        // A rigid rotor away from its joint takes the joint-space route, which the dense oracles cover.
        let robot = RandomRobot::new(seed, &Options { remote_rigid: false, remote_mount: 0.0, ..Options::default() });
        for fidelity in Fidelity::ALL {
            each_lane_equals(&robot, fidelity);
        }
    }
}

fn each_lane_equals(robot: &RandomRobot, fidelity: Fidelity) {
    let lowered = Lowered::<f64>::new(&robot.spec(), fidelity).expect("a random robot is valid");
    let model = lowered.view();
    let (n, nv) = (model.bodies().len(), model.nv());
    let points: [Point; 8] = core::array::from_fn(|k| {
        // Loads stay the lanes' own in the torques; wrenches are per body, not per joint, and left out here.
        Point { wrenches: Vec::new(), ..robot.state(k as u64) }
    });
    let [q, qd, theta, thetad] = [
        gather(&points, |p| &p.q),
        gather(&points, |p| &p.qd),
        gather(&points, |p| &p.theta),
        gather(&points, |p| &p.thetad),
    ];
    let (tau, tau_ext) = (gather(&points, |p| &p.tau), gather(&points, |p| &p.tau_ext));
    let (qdd, thetadd) = (gather(&points, |p| &p.qdd), gather(&points, |p| &p.thetadd));
    let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
    let ext = External { tau: &tau_ext, wrenches: &[] };
    let nan = Lanes([f64::NAN; 8]);

    let [mut a, mut b, mut c] = [vec![nan; nv], vec![nan; nv], vec![nan; nv]];
    let out = Forward { qdd: &mut a, thetadd: &mut b, tau_j: &mut c };
    aba(&model, state, &tau, ext, &mut vec![AbaScratch::new(); n], out).expect("slices fit the model");
    let [mut d, mut e] = [vec![nan; nv], vec![nan; nv]];
    let (accel, out) = (Acceleration { qdd: &qdd, thetadd: &thetadd }, Inverse { tau_j: &mut d, tau: &mut e });
    rnea(&model, state, accel, ext, &mut vec![RneaScratch::new(); n], out).expect("slices fit the model");
    let mut m = vec![nan; nv * nv];
    crba(&model, &q, &mut vec![CrbaScratch::new(); n], &mut m).expect("slices fit the model");
    let mut poses = vec![Transform::identity(); n];
    placements(&model, &q, &mut poses).expect("slices fit the model");

    let alone = Core::<f64>::new(&robot.spec(), fidelity);
    for (k, point) in points.iter().enumerate() {
        let (forward, inverse) = (alone.aba(point), alone.inverse(point));
        let same = |what: &str, got: &[Eight], want: &[f64]| {
            let error = relative_error(&lane(got, k), want, 0.0);
            let seed = robot.seed;
            assert!(error <= 1e-13, "{what} is off by {error:e}; seed {seed}, {}, lane {k}", fidelity.name());
        };
        same("qdd", &a, &forward.qdd);
        same("thetadd", &b, &forward.thetadd);
        same("tau_j of forward dynamics", &c, &forward.tau_j);
        same("tau_j", &d, &inverse.tau_j);
        same("tau", &e, &inverse.tau);
        same("inertia matrix", &m, &alone.mass_matrix(point));
        let mut single = vec![Transform::identity(); n];
        placements(&model, &point.q, &mut single).expect("slices fit the model");
        for (pose, single) in poses.iter().zip(&single) {
            same("position", &pose.pos.to_array(), &single.pos.to_array());
            for (row, single) in pose.rot.rows.iter().zip(&single.rot.rows) {
                same("rotation", &row.to_array(), &single.to_array());
            }
        }
    }
}
