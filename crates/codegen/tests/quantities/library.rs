//! The library's functions at the state of a robot, by the names of what is generated.

use super::scratch::Scratch;
use super::subject::{Known, Subject};
use gyroflex::dynamics::*;
use gyroflex::spatial::{Motion, Transform};
use gyroflex_testkit::tolerance::norm;

impl Subject {
    pub fn at(&self) -> State<'_, f64> {
        let s = &self.state;
        State { q: &s.q, qd: &s.qd, theta: &s.theta, thetad: &s.thetad }
    }

    pub fn accel(&self) -> Acceleration<'_, f64> {
        Acceleration { qdd: &self.state.qdd, thetadd: &self.state.thetadd }
    }

    fn scratch<X: Clone>(&self, one: X) -> Vec<X> {
        vec![one; self.bodies.len()]
    }

    fn nv(&self) -> usize {
        self.rigid.view().nv()
    }
}

/// `M` and `S`, of links that bend, too.
pub fn inertia(s: &Subject) -> [Vec<f64>; 2] {
    let Some(model) = s.robot().flexible else {
        return [mass_matrix(s), coupling_matrix(s)].map(|known| known[0].value.clone());
    };
    let [mut mass, mut coupling] = [(); 2].map(|()| vec![0.0; model.nv() * model.nv()]);
    let out = FlexibleMatrices { mass: &mut mass, coupling: &mut coupling };
    flexible_mass_matrix(&model, &s.state.q, Scratch::of(&model).lend(), out).expect("it fits");
    [mass, coupling]
}

/// `[M S; Sᵀ B]` times columns of accelerations, behind a rigid gear without what belongs to motors: torques.
pub fn weighed(s: &Subject, qdd: &[f64], thetadd: &[f64]) -> [Vec<f64>; 2] {
    let nv = s.state.qd.len();
    let ([m, c], b) = (inertia(s), &reflected(s)[0].value);
    let columns = qdd.len() / nv;
    let [mut link, mut motor] = [(); 2].map(|()| vec![0.0; nv * columns]);
    for (i, (link, motor)) in link.chunks_mut(columns).zip(motor.chunks_mut(columns)).enumerate() {
        for column in 0..columns {
            motor[column] = b[i] * thetadd[i * columns + column];
            for k in 0..nv {
                let (qdd, thetadd) = (qdd[k * columns + column], thetadd[k * columns + column]);
                link[column] += m[i * nv + k] * qdd + c[i * nv + k] * thetadd;
                motor[column] += c[k * nv + i] * qdd;
            }
        }
    }
    [link, motor]
}

pub fn forward_partials(s: &Subject) -> [Vec<f64>; 2] {
    let (model, nv) = (s.rigid.view(), s.nv());
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; nv]);
    let [mut dqdd, mut dthetadd] = [(); 2].map(|()| vec![0.0; 5 * nv * nv]);
    let value = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    let out = ForwardDerivatives { qdd: &mut dqdd, thetadd: &mut dthetadd };
    let mut matrix = vec![0.0; derivative_matrix_len(&model)];
    let mut scratch = s.scratch(DerivativeScratch::new());
    forward_derivatives(&model, s.at(), &s.state.tau, External::none(), &mut scratch, &mut matrix, value, out)
        .expect("it fits");
    [dqdd, dthetadd]
}

pub fn inverse_partials(s: &Subject) -> Vec<Known> {
    let [mut dtau_j, mut dtau] = [(); 2].map(|()| vec![0.0; 6 * s.nv() * s.nv()]);
    let out = InverseDerivatives { tau_j: &mut dtau_j, tau: &mut dtau };
    let mut scratch = s.scratch(DerivativeScratch::new());
    inverse_derivatives(&s.rigid.view(), s.at(), s.accel(), External::none(), &mut scratch, out).expect("it fits");
    // Torques are sums that turn with the angles: their derivatives have terms of their size.
    let size = norm(&inverse(s)[0].value);
    vec![Known::new("dtau_j", dtau_j).above(size), Known::new("dtau", dtau).above(size)]
}

pub fn forward(s: &Subject) -> [Vec<f64>; 3] {
    let (model, nv) = (s.rigid.view(), s.nv());
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; nv]);
    let scratch = ForwardScratch {
        bodies: &mut s.scratch(AbaScratch::new()),
        joint_space: &mut vec![JointSpaceScratch::new(); joint_space_len(&model)],
        matrix: &mut vec![0.0; matrix_len(&model)],
    };
    let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    forward_dynamics(&model, s.at(), &s.state.tau, External::none(), scratch, out).expect("it fits");
    [qdd, thetadd, tau_j]
}

pub fn torques(s: &Subject, qdd: &[f64], thetadd: &[f64]) -> [Vec<f64>; 2] {
    let (mut tau_j, mut tau) = (vec![0.0; s.nv()], vec![0.0; s.nv()]);
    let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
    let accel = Acceleration { qdd, thetadd };
    rnea(&s.rigid.view(), s.at(), accel, External::none(), &mut s.scratch(RneaScratch::new()), out).expect("it fits");
    [tau_j, tau]
}

pub fn inverse(s: &Subject) -> Vec<Known> {
    let [tau_j, tau] = torques(s, &s.state.qdd, &s.state.thetadd);
    vec![Known::new("tau_j", tau_j), Known::new("tau", tau)]
}

pub fn mass_matrix(s: &Subject) -> Vec<Known> {
    let mut m = vec![0.0; s.nv() * s.nv()];
    crba(&s.rigid.view(), &s.state.q, &mut s.scratch(CrbaScratch::new()), &mut m).expect("it fits");
    vec![Known::new("m", m)]
}

pub fn coupling_matrix(s: &Subject) -> Vec<Known> {
    let mut m = vec![0.0; s.nv() * s.nv()];
    coupling(&s.rigid.view(), &s.state.q, &mut s.scratch(CrbaScratch::new()), &mut m).expect("it fits");
    vec![Known::new("s", m)]
}

pub fn reflected(s: &Subject) -> Vec<Known> {
    let mut b = vec![0.0; s.state.qd.len()];
    reflected_inertia(&s.rigid.view(), &mut b[..s.nv()]).expect("it fits");
    vec![Known::new("b", b)]
}

pub fn coriolis(s: &Subject) -> Vec<Known> {
    let [mut c, mut c1, mut c2] = [(); 3].map(|()| vec![0.0; s.nv() * s.nv()]);
    let out = CoriolisMatrices { c: &mut c, c1: &mut c1, c2: &mut c2 };
    coriolis_matrices(&s.rigid.view(), s.at(), &mut s.scratch(DerivativeScratch::new()), out).expect("it fits");
    // Sums that may vanish of products of an inertia and a speed.
    let (spin, speed) = (spin(s), norm(&s.state.qd));
    let c = Known::new("c", c).above(norm(&mass_matrix(s)[0].value) * speed);
    vec![c, Known::new("c1", c1).above(spin), Known::new("c2", c2).above(spin)]
}

/// Size of the momenta of spinning rotors.
fn spin(s: &Subject) -> f64 {
    let spins = s.bodies.iter().filter_map(|body| body.drive).map(|drive| drive.gear_ratio * drive.rotor.inertia);
    norm(&spins.collect::<Vec<f64>>()) * norm(&s.state.qd)
}

pub fn gravity(s: &Subject) -> Vec<Known> {
    let mut g = vec![0.0; s.nv()];
    let mut scratch = s.scratch(DerivativeScratch::new());
    gravity_torques(&s.rigid.view(), &s.state.q, &mut scratch, &mut g).expect("it fits");
    vec![Known::new("g", g)]
}

pub fn bias_forces(s: &Subject) -> Vec<Known> {
    let [mut link, mut motor] = [(); 2].map(|()| vec![0.0; s.nv()]);
    let out = Bias { link: &mut link, motor: &mut motor };
    bias(&s.rigid.view(), s.at(), &mut s.scratch(DerivativeScratch::new()), out).expect("it fits");
    let motor = Known::new("motor", motor).above(spin(s) * norm(&s.state.qd));
    vec![Known::new("link", link), motor]
}

pub fn energies(s: &Subject) -> Vec<Known> {
    let mut scratch = s.scratch((Transform::identity(), Motion::zero()));
    let Energy { kinetic, gravity, elastic } = energy(&s.rigid.view(), s.at(), &mut scratch).expect("it fits");
    of_energy(s, kinetic, gravity, elastic)
}

/// A potential is a sum of either sign.
pub fn of_energy(s: &Subject, kinetic: f64, gravity: f64, elastic: f64) -> Vec<Known> {
    let mass: f64 = s.bodies.iter().map(|body| body.inertia.mass).sum();
    vec![
        Known::new("kinetic", vec![kinetic]),
        Known::new("gravity", vec![gravity]).above(mass * 9.81),
        Known::new("elastic", vec![elastic]),
    ]
}

pub fn regressors(s: &Subject) -> Vec<Known> {
    let len = s.nv() * PARAMETERS * s.bodies.len();
    let [mut link, mut transmission, mut motor] = [(); 3].map(|()| vec![0.0; len]);
    let out = Regressor { link: &mut link, transmission: &mut transmission, motor: &mut motor };
    let mut scratch = s.scratch(DerivativeScratch::new());
    regressor(&s.rigid.view(), s.at(), s.accel(), &mut scratch, out).expect("it fits");
    vec![Known::new("link", link), Known::new("transmission", transmission), Known::new("motor", motor)]
}

pub fn poses(s: &Subject) -> Vec<Known> {
    let mut poses = s.scratch(Transform::identity());
    placements(&s.rigid.view(), &s.state.q, &mut poses).expect("it fits");
    of_poses(&poses, ["positions", "rotations"]).into()
}

pub fn of_poses(poses: &[Transform<f64>], [positions, rotations]: [&'static str; 2]) -> [Known; 2] {
    let rows = |pose: &Transform<f64>| pose.rotation().rows.map(|row| row.to_array());
    let at = poses.iter().flat_map(|pose| pose.pos.to_array()).collect();
    [Known::new(positions, at).above(1.0), Known::new(rotations, poses.iter().flat_map(rows).flatten().collect())]
}

pub fn jacobian_of(s: &Subject, frame: Frame<f64>, axes: Axes) -> Vec<Known> {
    let mut poses = s.scratch(Transform::identity());
    placements(&s.rigid.view(), &s.state.q, &mut poses).expect("it fits");
    let mut j = vec![0.0; 6 * s.nv()];
    jacobian(&s.rigid.view(), &poses, frame, axes, &mut j).expect("it fits");
    vec![Known::new("j", j).above(1.0)]
}
