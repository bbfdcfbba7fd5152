//! The library on numbers that move along one coordinate.

use super::scratch::Scratch;
use super::subject::Subject;
use gyroflex::Scalar;
use gyroflex::dynamics::*;
use gyroflex_testkit::Dual;
use gyroflex_testkit::dual::moving_positions;

/// A state and what is asked for, as numbers with slopes.
pub struct Moving {
    q: Vec<Dual>,
    qd: Vec<Dual>,
    theta: Vec<Dual>,
    thetad: Vec<Dual>,
    pub rest: [Vec<Dual>; 2],
}

impl Moving {
    /// One coordinate at most of each vector moves at unit speed: of `q`, by a small motion of a floating root in its own frame, of
    /// `q̇, θ, θ̇` and of the vectors `rest`.
    pub fn along(s: &Subject, rest: [&[f64]; 2], moves: [Option<usize>; 6]) -> Self {
        let x = &s.state;
        let unit = |k: Option<usize>| (0..x.qd.len()).map(|i| f64::from(Some(i) == k)).collect::<Vec<f64>>();
        let moving = |x: &[f64], k: Option<usize>| -> Vec<Dual> {
            x.iter().zip(unit(k)).map(|(x, slope)| Dual::new(*x, slope)).collect()
        };
        let (q, slope) = (&x.q, unit(moves[0]));
        let (nq, nv) = (s.rigid.view().nq(), s.rigid.view().nv());
        let modes = q[nq..].iter().zip(&slope[nv..]).map(|(x, slope)| Dual::new(*x, *slope));
        Self {
            q: moving_positions(&q[..nq], &slope[..nv]).into_iter().chain(modes).collect(),
            qd: moving(&x.qd, moves[1]),
            theta: moving(&x.theta, moves[2]),
            thetad: moving(&x.thetad, moves[3]),
            rest: [moving(rest[0], moves[4]), moving(rest[1], moves[5])],
        }
    }

    fn state(&self) -> State<'_, Dual> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }
}

fn slopes(all: &[Dual]) -> Vec<f64> {
    all.iter().map(|x| x.slope).collect()
}

/// Slopes of `q̈` and `θ̈` where one coordinate of `q, q̇, θ, θ̇, τ` moves.
pub fn of_accelerations(s: &Subject, moves: [Option<usize>; 5]) -> [Vec<f64>; 2] {
    let [q, qd, theta, thetad, tau] = moves;
    let x = Moving::along(s, [&s.state.tau, &[]], [q, qd, theta, thetad, tau, None]);
    let (model, nv) = (s.rigid.view(), s.state.qd.len());
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![Dual::zero(); nv]);
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    match s.robot().flexible {
        Some(model) => flexible_aba(&model, x.state(), &x.rest[0], External::none(), Scratch::of(&model).lend(), out),
        None => {
            let scratch = ForwardScratch {
                bodies: &mut vec![AbaScratch::new(); s.bodies.len()],
                joint_space: &mut vec![JointSpaceScratch::new(); joint_space_len(&model)],
                matrix: &mut vec![Dual::zero(); matrix_len(&model)],
            };
            forward_dynamics(&model, x.state(), &x.rest[0], External::none(), scratch, out)
        }
    }
    .expect("it fits");
    [slopes(&qdd), slopes(&thetadd)]
}

/// Slopes of `τ_J` and `τ` of a robot whose links bend, where one coordinate of `q, q̇, θ, θ̇, q̈, θ̈` moves.
pub fn of_torques(s: &Subject, moves: [Option<usize>; 6]) -> [Vec<f64>; 2] {
    let x = Moving::along(s, [&s.state.qdd, &s.state.thetadd], moves);
    let model = s.robot().flexible.expect("a link bends");
    let [mut tau_j, mut tau] = [(); 2].map(|()| vec![Dual::zero(); model.nv()]);
    let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
    let accel = Acceleration { qdd: &x.rest[0], thetadd: &x.rest[1] };
    flexible_rnea(&model, x.state(), accel, External::none(), Scratch::of(&model).lend(), out).expect("it fits");
    [slopes(&tau_j), slopes(&tau)]
}

/// `Ṁ` and `Ṡ` of a robot whose links bend.
pub fn of_inertia(s: &Subject) -> [Vec<f64>; 2] {
    let x = &s.state;
    let model = s.robot().flexible.expect("a link bends");
    let (nq, nv) = (model.rigid().nq(), model.rigid().nv());
    let modes = x.q[nq..].iter().zip(&x.qd[nv..]).map(|(x, slope)| Dual::new(*x, *slope));
    let q: Vec<Dual> = moving_positions(&x.q[..nq], &x.qd[..nv]).into_iter().chain(modes).collect();
    let [mut mass, mut coupling] = [(); 2].map(|()| vec![Dual::zero(); model.nv() * model.nv()]);
    let out = FlexibleMatrices { mass: &mut mass, coupling: &mut coupling };
    flexible_mass_matrix(&model, &q, Scratch::of(&model).lend(), out).expect("it fits");
    [slopes(&mass), slopes(&coupling)]
}
