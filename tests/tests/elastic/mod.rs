//! Motions for the inverse, and an inverse of another kind.

use gyroflex::dynamics::{Acceleration, External, Inverse, JointOrders, RneaScratch, State, rnea};
use gyroflex::model::{Model, SpringSpec, TransmissionSpec};
use gyroflex::{Jet, Scalar};
use gyroflex_testkit::random::RandomRobot;
use gyroflex_tests::LinkMotion;

/// A motion of random derivatives, as many as the orders ask for, loads that change, and deflections of usual size.
pub fn random_motion(robot: &RandomRobot, model: &Model<'_, f64>, orders: &[JointOrders], index: u64) -> LinkMotion {
    let order = orders.iter().map(|o| usize::from(o.position)).max().unwrap_or(0).max(2);
    let of = |row: usize| robot.state(1 + index + 100 * row as u64);
    let start = of(0);
    let mut deflection = vec![0.0; robot.nv()];
    for body in model.bodies().iter().filter(|b| b.is_elastic()) {
        let (k, drive) = (body.v_index(), body.drive.expect("an elastic joint has a drive"));
        let error = drive.elastic.and_then(|e| e.error);
        let e = error.map_or(0.0, |e| e.value_and_slope(start.theta[k], drive.rotor.gear_ratio).0);
        deflection[k] = start.theta[k] - start.q[body.q_index()] - e;
    }
    LinkMotion {
        q: start.q,
        // Of about 2 π rad/s.
        derivatives: (1..=order)
            .map(|row| of(row).qd.iter().map(|x| 0.1 * x * 6f64.powi(row as i32)).collect())
            .collect(),
        deflection,
        step: 1e-3,
        tau_ext: (0..3).map(|row| of(row).tau_ext).collect(),
        wrenches: (0..3).map(|row| of(row).wrenches).collect(),
    }
}

/// The same robot with damping by which every transmission settles in a hundredth of a second or later: the derivatives of faster
/// transients are beyond all measure.
pub fn settling(mut robot: RandomRobot) -> RandomRobot {
    for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        let TransmissionSpec::Elastic { spring, damping, .. } = &mut drive.transmission else { continue };
        let stiffness = match *spring {
            SpringSpec::Polynomial { stiffness, .. } => stiffness,
            SpringSpec::Table { first, .. } => {
                let [a, b] = [robot.spring_tables[first], robot.spring_tables[first + 1]];
                (b[1] - a[1]) / (b[0] - a[0])
            }
        };
        if *damping > 0.0 {
            *damping = damping.max(stiffness / 100.0);
        }
    }
    robot
}

/// How large rounding makes the accelerations of forward dynamics: of deflections, differences of positions that stiff springs multiply,
/// and of torques, differences of which move small inertias [rad/s²].
pub fn rounding_of_forward(model: &Model<'_, f64>, s: &gyroflex_testkit::State, tau_j: &[f64]) -> f64 {
    let rotors = model.bodies().iter().filter(|b| b.is_elastic()).filter_map(|b| b.drive);
    let small = rotors.map(|d| d.rotor.reflected_inertia).fold(0.01, f64::min);
    let elastic = model.bodies().iter().filter(|b| b.is_elastic());
    let spring = |b: &gyroflex::model::Body<f64>| {
        let (k, elastic) = (b.v_index(), b.drive.and_then(|d| d.elastic).expect("the joint is elastic"));
        let stiffness = elastic.spring.slope(s.theta[k] - s.q[b.q_index()], model.knots());
        stiffness * (1.0 + s.q[b.q_index()].abs()) + elastic.damping * s.thetad[k].abs()
    };
    let springs = elastic.map(spring).fold(0.0, f64::max);
    let torques = s.tau.iter().chain(tau_j).fold(0.0, |most: f64, x| most.max(x.abs()));
    4.0 * f64::EPSILON * (springs + torques) / small
}

/// What a robot's motors do; elsewhere what is wanted, so that both can be compared.
pub fn at_motors(model: &Model<'_, f64>, got: &[f64], wanted: &[f64]) -> Vec<f64> {
    let mut out = wanted.to_vec();
    for k in model.bodies().iter().filter(|b| b.is_elastic()).map(|b| b.v_index()) {
        out[k] = got[k];
    }
    out
}

const K: usize = 26;
type Series = Jet<f64, K>;

/// Motor positions `θ, θ̇, θ̈` and torques `τ_J, τ` of an undamped robot on a fixed base whose links move along polynomials in time, by
/// another way than the core's: [`rnea`] on series of all joints at once, again and again, each sweep with the motors where the torques
/// of the last one put them, until all of them, joint by joint from the tips, are right. Springs are inverted by Newton's method on whole series.
pub fn series_by_sweeps(model: &Model<'_, f64>, motion: &LinkMotion) -> [Vec<f64>; 5] {
    let nv = model.nv();
    let series = |k: usize| {
        let all = std::iter::once(motion.q[k]).chain(motion.derivatives.iter().map(|row| row[k]));
        Series::from_derivatives(&all.collect::<Vec<_>>())
    };
    let load = |k: usize| Series::from_derivatives(&motion.tau_ext.iter().map(|row| row[k]).collect::<Vec<_>>());
    let wrench = |body: usize| {
        let entry = |i: usize| motion.wrenches.iter().map(|row| row[body][i]).collect::<Vec<_>>();
        gyroflex::spatial::Force::from(std::array::from_fn::<_, 6, _>(|i| Series::from_derivatives(&entry(i))))
    };
    let q: Vec<Series> = (0..nv).map(series).collect();
    let rates = |x: &[Series]| x.iter().map(Series::rate).collect::<Vec<_>>();
    let qd = rates(&q);
    let qdd = rates(&qd);
    let tau_ext: Vec<Series> = (0..nv).map(load).collect();
    let wrenches: Vec<_> = (0..nv).map(wrench).collect();
    let mut theta = q.clone();
    let (mut tau_j, mut tau) = (vec![Series::zero(); nv], vec![Series::zero(); nv]);
    for _ in 0..nv + 2 {
        let thetad = rates(&theta);
        let thetadd = rates(&thetad);
        let state = State { q: &q, qd: &qd, theta: &theta, thetad: &thetad };
        let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
        let ext = External { tau: &tau_ext, wrenches: &wrenches };
        let mut scratch = vec![RneaScratch::new(); nv];
        rnea(model, state, accel, ext, &mut scratch, Inverse { tau_j: &mut tau_j, tau: &mut tau }).expect("it fits");
        for body in model.bodies() {
            let (k, Some(drive)) = (body.v_index(), &body.drive) else { continue };
            let Some(elastic) = &drive.elastic else { continue };
            let spring = &elastic.spring;
            let mut delta = tau_j[k] / Series::from_f64(spring.stiffness);
            for _ in 0..60 {
                let miss = spring.torque(delta, model.knots()) - tau_j[k];
                delta -= miss / spring.slope(delta, model.knots());
            }
            let target = q[k] + delta;
            theta[k] = target;
            let Some(error) = &elastic.error else { continue };
            let ratio = Series::from_f64(drive.rotor.gear_ratio);
            for _ in 0..60 {
                let (e, slope) = error.value_and_slope(theta[k], ratio);
                let miss = theta[k] - e - target;
                theta[k] -= miss / (Series::one() - slope);
            }
        }
    }
    let value = |x: &[Series]| x.iter().map(Series::value).collect::<Vec<_>>();
    let thetad = rates(&theta);
    [value(&theta), value(&thetad), value(&rates(&thetad)), value(&tau_j), value(&tau)]
}
