//! Inverse dynamics is linear in the parameters of the robot.

use gyroflex::dynamics::{Acceleration, DerivativeScratch, PARAMETERS, Regressor, State, parameters, regressor};
use gyroflex::model::Fidelity;
use gyroflex_testkit::State as Point;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{norm, tol};
use gyroflex_tests::{Trial, for_trials};

/// `Y π` of links, transmissions and motors.
fn torques(t: &Trial<'_, f64>, s: &Point) -> [Vec<f64>; 3] {
    let model = t.core.model();
    let (nv, width) = (model.nv(), PARAMETERS * model.bodies().len());
    let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
    let mut y = [(); 3].map(|()| vec![f64::NAN; nv * width]);
    let [link, transmission, motor] = &mut y;
    let state = State { q: &s.q, qd: &s.qd, theta: &s.theta, thetad: &s.thetad };
    let accel = Acceleration { qdd: &s.qdd, thetadd: &s.thetadd };
    regressor(&model, state, accel, &mut scratch, Regressor { link, transmission, motor }).expect("slices fit");
    let mut pi = vec![f64::NAN; width];
    parameters(&model, &mut pi).expect("the slice fits");
    y.map(|y| y.chunks(width).map(|row| row.iter().zip(&pi).map(|(y, pi)| y * pi).sum()).collect())
}

fn unloaded(s: &Point) -> Point {
    Point { tau_ext: Vec::new(), wrenches: Vec::new(), ..s.clone() }
}

#[test]
fn regressor_times_parameters_is_inverse_dynamics() {
    for_trials::<f64>(300, &Options::default(), &Fidelity::ALL, tol(1e-10, 0.0), |t| {
        let s = unloaded(&t.state);
        let [link, _, motor] = torques(t, &s);
        let want = t.core.inverse(&s);
        t.assert_close("links", &link, &want.tau_j, 0.0);
        let passed = t.oracle().passed_by_transmissions(&s);
        let tau: Vec<f64> = (0..link.len()).map(|k| passed[k] * link[k] + motor[k]).collect();
        t.assert_close("motors", &tau, &want.tau, norm(&motor));
    });
}

/// Without loads and friction, what the transmission exerts is what forward dynamics says it does.
#[test]
fn regressor_of_the_transmissions_is_their_torque() {
    let options = Options { table: 0.0, ..Options::default() };
    for_trials::<f64>(200, &options, &[Fidelity::Complete, Fidelity::Reduced], tol(1e-10, 0.0), |t| {
        let s = unloaded(&t.state);
        let [_, transmission, _] = torques(t, &s);
        let want = t.core.forward(&s).tau_j;
        let elastic: Vec<bool> =
            t.core.model().bodies().iter().flat_map(|b| vec![b.is_elastic(); b.joint.nv()]).collect();
        let of_elastic =
            |x: &[f64]| -> Vec<f64> { (0..x.len()).map(|k| if elastic[k] { x[k] } else { 0.0 }).collect() };
        t.assert_close("transmissions", &transmission, &of_elastic(&want), 0.0);
    });
}
