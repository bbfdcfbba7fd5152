//! Robots and motions whose inverse is known, and an inverse of another kind.

use gyroflex::dynamics::{Acceleration, External, Inverse, RneaScratch, State, rnea};
use gyroflex::model::{
    BodySpec, DriveSpec, Friction, JointKind, Model, MountSpec, RobotSpec, RotorSpec, SpringSpec, TransmissionError,
    TransmissionSpec,
};
use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
use gyroflex::{Jet, Scalar};
use gyroflex_tests::LinkMotion;

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

/// The same motion a time `t` later: its derivatives are those of a polynomial.
pub fn later(motion: &LinkMotion, t: f64) -> LinkMotion {
    let shift = |rows: &[&[f64]], k: usize| -> Vec<f64> {
        let term = |j: usize, i: usize| rows[k + j][i] * t.powi(j as i32) / (1..=j).map(|x| x as f64).product::<f64>();
        (0..rows[k].len()).map(|i| (0..rows.len() - k).map(|j| term(j, i)).sum()).collect()
    };
    let all = |rows: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        (0..rows.len()).map(|k| shift(&rows, k)).collect()
    };
    let mut positions = vec![motion.q.clone()];
    positions.extend(motion.derivatives.iter().cloned());
    let mut moved = all(&positions);
    let wrenches: Vec<Vec<f64>> = motion.wrenches.iter().map(|row| row.concat()).collect();
    let unflatten = |row: Vec<f64>| row.chunks(6).map(|w| std::array::from_fn(|i| w[i])).collect();
    LinkMotion {
        q: moved.remove(0),
        derivatives: moved,
        tau_ext: all(&motion.tau_ext),
        wrenches: all(&wrenches).into_iter().map(unflatten).collect(),
        ..motion.clone()
    }
}

/// Every number as single precision has it.
pub fn rounded(motion: LinkMotion) -> LinkMotion {
    let row = |x: Vec<f64>| -> Vec<f64> { x.into_iter().map(|x| f64::from(x as f32)).collect() };
    let rows = |x: Vec<Vec<f64>>| x.into_iter().map(row).collect();
    let wrenches = motion.wrenches.into_iter();
    LinkMotion {
        q: row(motion.q),
        derivatives: rows(motion.derivatives),
        deflection: row(motion.deflection),
        step: f64::from(motion.step as f32),
        tau_ext: rows(motion.tau_ext),
        wrenches: wrenches.map(|w| w.into_iter().map(|w| w.map(|x| f64::from(x as f32))).collect()).collect(),
    }
}

/// A link about a vertical axis through its centre of mass, its motor on the ground.
pub fn turntable(inertia: f64, stiffness: f64, cubic: f64, damping: f64) -> BodySpec {
    let axis = Vec3::new(0.0, 0.0, 1.0);
    BodySpec {
        parent: None,
        joint: JointKind::Revolute,
        axis,
        placement: Transform::identity(),
        inertia: SpatialInertia::from_com(1.0, Vec3::zero(), SymMat3::diagonal(inertia, inertia, inertia)),
        friction: Friction::none(),
        drive: Some(DriveSpec {
            rotor: RotorSpec {
                inertia: 1e-4,
                body: None,
                mount: MountSpec { body: None, placement: Transform::identity(), axis },
            },
            gear_ratio: 100.0,
            transmission: TransmissionSpec::Elastic {
                spring: SpringSpec::Polynomial { stiffness, cubic },
                damping,
                error: TransmissionError::none(),
            },
            friction: Friction::none(),
        }),
    }
}

/// The robot of these bodies.
pub fn spec(bodies: &[BodySpec]) -> RobotSpec<'_> {
    RobotSpec { bodies, spring_tables: &[], gravity: [0.0, 0.0, -9.81].into() }
}

/// `D δ̇ + K δ = Σ τ_k tᵏ/k!` solved: the convolution of each power with the decay, by its own power series where the decay is slow, by
/// the particular polynomial where it is fast.
pub fn damped_deflection(torque: &[f64], stiffness: f64, damping: f64, start: f64, t: f64) -> f64 {
    let decay = stiffness / damping;
    let factorial = |n: usize| (1..=n).map(|x| x as f64).product::<f64>();
    if decay * t < 2.0 {
        // ∫₀ᵗ e^{−λ(t−s)} sᵏ/k! ds = Σ_j (−λ)ʲ t^{k+1+j}/(k+1+j)!
        let integral = |k: usize| {
            (0..60).map(|j| (-decay).powi(j) * t.powi(k as i32 + 1 + j) / factorial(k + 1 + j as usize)).sum::<f64>()
        };
        let forced: f64 = torque.iter().enumerate().map(|(k, tau)| tau / damping * integral(k)).sum();
        return start * (-decay * t).exp() + forced;
    }
    // p = Σ_j (−1/λ)ʲ τ⁽ʲ⁾ / K
    let polynomial = |t: f64| {
        let derivative = |j: usize| {
            torque
                .iter()
                .enumerate()
                .skip(j)
                .map(|(k, tau)| tau * t.powi((k - j) as i32) / factorial(k - j))
                .sum::<f64>()
        };
        (0..torque.len()).map(|j| (-1.0 / decay).powi(j as i32) * derivative(j) / stiffness).sum::<f64>()
    };
    polynomial(t) + (start - polynomial(0.0)) * (-decay * t).exp()
}
