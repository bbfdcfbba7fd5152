//! From a state to a sample: everything that is logged.

use crate::bending::{CrossSection, Tip};
use crate::contact::Contacts;
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::link_frame::LinkFrame;
use crate::loads::Loads;
use crate::record::Sample;
use crate::reference::Point;
use crate::robot::Robot;
use gyroflex::dynamics::{Acceleration, External, Forward, Inverse, State};
use gyroflex::spatial::{Force, Motion, Transform, Vec3};

/// Fills samples without allocating.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    joints: Coordinates,
    links: Vec<Seen>,
    rotors: Vec<Rotor>,
    /// Tips of the links that bend.
    tips: Vec<CrossSection>,
    /// The robot without gravity, for torques of the rotors' couples alone.
    weightless: Option<Dynamics>,
    poses: Vec<Transform<f64>>,
    velocities: Vec<Motion<f64>>,
    couples: Vec<Force<f64>>,
    qdd: Vec<f64>,
    thetadd: Vec<f64>,
    tau_j: Vec<f64>,
    rest: Vec<f64>,
    torque: Vec<f64>,
    unused: Vec<f64>,
    m: Vec<f64>,
    s: Vec<f64>,
    pub(crate) sample: Sample,
}

/// A link's frame, and its parent among the links.
#[derive(Clone, Debug)]
struct Seen {
    frame: LinkFrame,
    parent: Option<usize>,
}

/// A rotor whose carrier is a moving body.
#[derive(Clone, Debug)]
struct Rotor {
    v: usize,
    mount: usize,
    /// Spin axis in the carrier's link frame.
    axis: Vec3<f64>,
    /// `N J` [kg m²].
    momentum: f64,
    /// Where it sits on a link that bends.
    section: Option<CrossSection>,
}

impl Sampler {
    pub(crate) fn new(robot: &Robot, joints: &Coordinates, dynamics: &Dynamics) -> Result<Self, Error> {
        let (nv, bodies, n) = (dynamics.nv(), robot.bodies.len(), joints.len());
        let fidelity = dynamics.owned_model().fidelity;
        let mut rotors = Vec::new();
        if fidelity.is_gyroscopic() {
            for joint in &joints.joints {
                let Some(drive) = &robot.bodies[joint.body].drive else { continue };
                let mount = drive.rotor.mount;
                let Some(body) = mount.body else { continue };
                let axis = mount.placement.rotation() * mount.axis;
                let momentum = drive.gear_ratio * drive.rotor.inertia;
                let seat = robot.flexible.seats.get(joint.body).and_then(|seat| seat.rotor);
                let section = seat.map(|place| {
                    let x = robot.flexible.links[place.link].stations[place.station].x;
                    CrossSection::new(&robot.flexible, place.link, x)
                });
                rotors.push(Rotor { v: joint.v, mount: body, axis, momentum, section });
            }
        }
        let weightless = if rotors.is_empty() {
            None
        } else {
            let robot = Robot { gravity: Vec3::zero(), ..robot.clone() };
            Some(Dynamics::new(robot.model(fidelity)?))
        };
        let parent = |name: &String| robot.links.iter().position(|l| l.name == *name);
        let links = robot
            .links
            .iter()
            .enumerate()
            .map(|(i, link)| Seen { frame: LinkFrame::new(robot, i), parent: link.parent.as_ref().and_then(parent) });
        let tips = CrossSection::tips(&robot.flexible);
        let zeros = vec![0.0; n];
        let sample = Sample {
            q: zeros.clone(),
            qd: zeros.clone(),
            qdd: zeros.clone(),
            theta: zeros.clone(),
            thetad: zeros.clone(),
            thetadd: zeros.clone(),
            deflection: zeros.clone(),
            tau_j: zeros.clone(),
            tau: zeros.clone(),
            gyroscopic: zeros.clone(),
            friction: zeros.clone(),
            reference: zeros.clone(),
            tracking_error: zeros,
            frames: vec![Transform::identity(); robot.links.len()],
            tips: vec![Tip::default(); tips.len()],
            ..Sample::default()
        };
        Ok(Self {
            joints: joints.clone(),
            links: links.collect(),
            rotors,
            tips,
            weightless,
            poses: vec![Transform::identity(); bodies],
            velocities: vec![Motion::zero(); bodies],
            couples: vec![Force::zero(); bodies],
            qdd: vec![0.0; nv],
            thetadd: vec![0.0; nv],
            tau_j: vec![0.0; nv],
            rest: vec![0.0; nv],
            torque: vec![0.0; nv],
            unused: vec![0.0; nv],
            m: vec![0.0; nv * nv],
            s: vec![0.0; nv * nv],
            sample,
        })
    }

    /// Fills the sample of one instant; `loads` are those of that instant.
    #[expect(clippy::too_many_arguments, reason = "a sample is of all of them")]
    pub(crate) fn take(
        &mut self,
        t: f64,
        dynamics: &mut Dynamics,
        state: State<f64>,
        tau: &[f64],
        loads: &mut Loads,
        contacts: Option<&mut Contacts>,
        reference: &[Point],
    ) -> Result<(), Error> {
        let out = Forward { qdd: &mut self.qdd, thetadd: &mut self.thetadd, tau_j: &mut self.tau_j };
        match contacts {
            Some(contacts) => {
                contacts.forward(dynamics, state, tau, loads, out)?;
                let footing = self.sample.footing.get_or_insert_default();
                contacts.report(dynamics, state.q, loads.couple(), footing)?;
            }
            None => {
                loads.update(dynamics, state.q)?;
                dynamics.forward(state, tau, loads.external(), out)?;
            }
        }
        self.gyroscopic_torque(dynamics, state)?;
        self.significance(dynamics, state)?;
        self.frames(dynamics, state.q)?;
        let (energy, power) = (dynamics.energy(state)?, dynamics.power(state, tau, loads.external())?);

        let sample = &mut self.sample;
        sample.t = t;
        if self.joints.floating {
            sample.base_pose = state.q.first_chunk().copied();
            sample.base_twist = state.qd.first_chunk().copied();
        }
        let model = dynamics.model();
        for (i, joint) in self.joints.joints.iter().enumerate() {
            let (k, body) = (joint.v, &model.bodies()[joint.body]);
            sample.q[i] = state.q[joint.q];
            sample.qd[i] = state.qd[k];
            sample.qdd[i] = self.qdd[k];
            (sample.theta[i], sample.thetad[i]) = (state.q[joint.q], state.qd[k]);
            sample.thetadd[i] = self.thetadd[k];
            sample.deflection[i] = 0.0;
            sample.tau_j[i] = self.tau_j[k];
            sample.tau[i] = tau[k];
            sample.gyroscopic[i] = self.torque[k];
            sample.friction[i] = body.friction.torque(state.qd[k]);
            sample.reference[i] = reference[i].q;
            sample.tracking_error[i] = reference[i].q - state.q[joint.q];
            let Some(drive) = body.drive.as_ref() else { continue };
            if let Some(elastic) = &drive.elastic {
                (sample.theta[i], sample.thetad[i]) = (state.theta[k], state.thetad[k]);
                let error = elastic.error.map_or(0.0, |e| e.value_and_slope(state.theta[k], drive.rotor.gear_ratio).0);
                sample.deflection[i] = state.theta[k] - state.q[joint.q] - error;
            }
            sample.friction[i] += drive.rotor.reflected_friction(sample.thetad[i]);
        }
        let (joints, eta) = (state.qd.len() - self.joints.modes.len(), dynamics.eta(state.q));
        for (to, from) in
            [(&mut sample.eta, eta), (&mut sample.etad, &state.qd[joints..]), (&mut sample.etadd, &self.qdd[joints..])]
        {
            to.clear();
            to.extend_from_slice(from);
        }
        sample.tips.iter_mut().zip(&self.tips).for_each(|(tip, section)| *tip = section.deflection(eta));
        sample.kinetic_energy = energy.kinetic;
        sample.gravity_energy = energy.gravity;
        sample.elastic_energy = energy.elastic;
        sample.power_in = power.supplied;
        sample.dissipation = power.dissipated;
        Ok(())
    }

    /// `S θ̈ + C₁ θ̇`: each rotor asks of its carrier the couple `N J (θ̈ n + ω × θ̇ n)` (PHYSICS: rotor couples); the joints
    /// carry it to the base as inverse dynamics at rest carries the opposite external couple.
    fn gyroscopic_torque(&mut self, dynamics: &Dynamics, state: State<f64>) -> Result<(), Error> {
        self.torque.fill(0.0);
        let Some(weightless) = &mut self.weightless else { return Ok(()) };
        dynamics.velocities(state.q, state.qd, &mut self.velocities)?;
        let (eta, etad) = (dynamics.eta(state.q), &state.qd[state.qd.len() - self.joints.modes.len()..]);
        self.couples.fill(Force::zero());
        for rotor in &self.rotors {
            let mut omega = self.velocities[rotor.mount].ang;
            let carried = rotor.section.as_ref().map(|section| {
                let pose = section.pose(eta);
                omega = pose.rot * omega + section.velocity(eta, etad).ang;
                pose
            });
            let (rate, acceleration) = (state.thetad[rotor.v], self.thetadd[rotor.v]);
            let couple = rotor.axis.scale(acceleration) + omega.cross(rotor.axis).scale(rate);
            let couple = Force::couple(couple.scale(-rotor.momentum));
            self.couples[rotor.mount] += carried.map_or(couple, |pose| pose.inv_force(couple));
        }
        let rest = self.rest.as_slice();
        let still = State { q: state.q, qd: rest, theta: rest, thetad: rest };
        let accel = Acceleration { qdd: rest, thetadd: rest };
        let ext = External { tau: &[], wrenches: &self.couples };
        weightless.inverse(still, accel, ext, Inverse { tau_j: &mut self.torque, tau: &mut self.unused })
    }

    /// `r_s = 2 q̇ᵀ S q̇ / q̇ᵀ M_l q̇` (Zhao et al. 2015, eq. 12), zero at rest.
    fn significance(&mut self, dynamics: &mut Dynamics, state: State<f64>) -> Result<(), Error> {
        let nv = state.qd.len();
        dynamics.mass_matrix(state.q, &mut self.m)?;
        dynamics.coupling(state.q, &mut self.s)?;
        let form = |a: &[f64]| -> f64 {
            let row = |i: usize| a[i * nv..(i + 1) * nv].iter().zip(state.qd).map(|(x, v)| x * v).sum::<f64>();
            (0..nv).map(|i| state.qd[i] * row(i)).sum()
        };
        let inertia = form(&self.m);
        self.sample.significance = if inertia > f64::MIN_POSITIVE { 2.0 * form(&self.s) / inertia } else { 0.0 };
        Ok(())
    }

    /// Pose of every link in its parent.
    fn frames(&mut self, dynamics: &Dynamics, q: &[f64]) -> Result<(), Error> {
        dynamics.placements(q, &mut self.poses)?;
        let eta = dynamics.eta(q);
        for (i, link) in self.links.iter().enumerate() {
            let from_world = |seen: &Seen| seen.frame.pose(&self.poses, eta);
            let own = from_world(link);
            self.sample.frames[i] = match link.parent {
                Some(parent) => own.after(from_world(&self.links[parent]).inverse()),
                None => own,
            };
        }
        Ok(())
    }
}
