//! Energies, powers and poses of a robot whose links bend.

use super::link::Deflected;
use super::outward::Known;
use super::scratch::FlexibleScratch;
use crate::Scalar;
use crate::dynamics::drive_torque::{JointState, transmitted};
use crate::dynamics::tree::RootMotion;
use crate::dynamics::{Energy, External, Power, State};
use crate::model::{Body, FlexibleModel, JointKind, SizeError};
use crate::spatial::{Motion, SpatialInertia, Transform, Vec3};

/// Energies of a robot whose links bend; `elastic` is that of transmissions and links.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model.
pub fn flexible_energy<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    state: State<T>,
    mut scratch: FlexibleScratch<T>,
) -> Result<Energy<T>, SizeError> {
    let known = Known::of(model, state, External::none())?;
    scratch.check(model)?;
    known.move_frames(&mut scratch);
    let half = T::from_f64(0.5);
    let gravity = model.rigid.gravity.map(T::from_param);
    let mut e = Energy { kinetic: T::zero(), gravity: T::zero(), elastic: T::zero() };
    for (i, body) in model.rigid.bodies.iter().enumerate() {
        let s = scratch.bodies[i];
        e.add(gravity, s.inertia, s.pose, s.a);
        if let Some(link) = model.link_of(i) {
            // T = ½ vᵀ I v + v·Σ U_j η̇_j + ½ η̇ᵀ M η̇
            let own = Deflected::<T::Param, T>::of(model, link, known.eta, known.etad);
            for (mode, etad) in scratch.modes[link.mode_range()].iter().zip(&known.etad[link.mode_range()]) {
                e.kinetic += s.a.dot(mode.u_cap) * *etad;
            }
            e.kinetic += own.modal_kinetic_energy();
            e.elastic += own.elastic_energy();
            for k in link.station_range() {
                let lumps: SpatialInertia<T> = model.stations[k].inertia.map(T::from_param);
                let station = scratch.stations[k];
                e.add(gravity, lumps, station.x.after(s.pose), station.a);
            }
        }
        // Rotors: elastic ½ h²/J, since the carrier's inertia lacks J n nᵀ; rigid ½ B q̇² + N J q̇ n·ω on top of it.
        let Some(drive) = &body.drive else { continue };
        let rotor = &drive.rotor;
        let axial = rotor.axis_in().dot(known.of_carrier(i, &scratch, (|s| s.omega, |b| b.omega), Vec3::zero()));
        let (n, j) = (T::from_param(rotor.gear_ratio), T::from_param(rotor.inertia));
        match &drive.elastic {
            Some(elastic) => {
                let spin = n * state.thetad[body.v_index()] + axial;
                e.kinetic += half * j * spin * spin;
                let t = transmitted(elastic, rotor, known.joint_state(body), model.rigid.knots);
                e.elastic += elastic.spring.energy(t.deflection, model.rigid.knots);
            }
            None => {
                let spin = n * known.qd(body);
                e.kinetic += j * spin * (half * spin + axial);
            }
        }
    }
    Ok(e)
}

/// Power supplied by motor torques, forces on modes and external loads, and dissipated by friction and the damping of transmissions
/// and links.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model.
pub fn flexible_power<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    mut scratch: FlexibleScratch<T>,
) -> Result<Power<T>, SizeError> {
    let known = Known::of(model, state, ext)?;
    scratch.check(model)?;
    SizeError::check("tau", tau.len(), model.nv())?;
    known.move_frames(&mut scratch);
    let mut p = Power { supplied: T::zero(), dissipated: T::zero() };
    for (tau, qd) in ext.tau.iter().zip(state.qd) {
        p.supplied += *tau * *qd;
    }
    for (tau, etad) in tau[model.rigid.nv..].iter().zip(known.etad) {
        p.supplied += *tau * *etad;
    }
    for link in model.links {
        p.dissipated += Deflected::<T::Param, T>::of(model, link, known.eta, known.etad).dissipated();
    }
    for (i, body) in model.rigid.bodies.iter().enumerate() {
        if let Some(wrench) = ext.wrenches.get(i) {
            p.supplied += scratch.bodies[i].a.dot(body.frame.map(T::from_param).inv_force(*wrench));
        }
        let v = body.v_index();
        if body.joint == JointKind::Floating {
            for k in v..v + 6 {
                p.supplied += tau[k] * state.qd[k];
            }
            continue;
        }
        let qd = known.qd(body);
        p.dissipated += body.friction.torque(qd) * qd;
        let mut motor_velocity = qd;
        if let Some(drive) = &body.drive {
            if let Some(elastic) = &drive.elastic {
                motor_velocity = state.thetad[v];
                let rate = transmitted(elastic, &drive.rotor, known.joint_state(body), model.rigid.knots).rate;
                p.dissipated += T::from_param(elastic.damping) * rate * rate;
            }
            p.dissipated += drive.rotor.reflected_friction(motor_velocity) * motor_velocity;
        }
        p.supplied += tau[v] * motor_velocity;
    }
    Ok(p)
}

/// What [`flexible_placements`] writes.
#[derive(Debug)]
pub struct FlexiblePlacements<'a, T> {
    /// From the world to every link frame, one per body.
    pub links: &'a mut [Transform<T>],
    /// From the world to every station's frame, one per station: the link frame as the station carries it, which at rest is the link's own.
    pub stations: &'a mut [Transform<T>],
}

/// Where links and stations are.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn flexible_placements<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    q: &[T],
    mut scratch: FlexibleScratch<T>,
    out: FlexiblePlacements<T>,
) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq())?;
    scratch.check(model)?;
    SizeError::check("links", out.links.len(), model.rigid.bodies.len())?;
    SizeError::check("stations", out.stations.len(), model.stations.len())?;
    // Velocities are of no concern.
    let any = &q[..model.nv()];
    let known = Known::of(model, State { q, qd: any, theta: any, thetad: any }, External::none())?;
    known.move_frames(&mut scratch);
    for (i, body) in model.rigid.bodies.iter().enumerate() {
        let (frame, pose) = (body.frame.map(T::from_param), scratch.bodies[i].pose);
        out.links[i] = frame.after(pose);
        for k in model.link_of(i).map_or(0..0, |link| link.station_range()) {
            out.stations[k] = frame.after(scratch.stations[k].x.after(pose));
        }
    }
    Ok(())
}

/// Spatial velocity of every link in its own link frame: one motion vector per body, angular first.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn flexible_velocities<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    q: &[T],
    qd: &[T],
    mut scratch: FlexibleScratch<T>,
    out: &mut [Motion<T>],
) -> Result<(), SizeError> {
    let known = Known::of(model, State { q, qd, theta: qd, thetad: qd }, External::none())?;
    scratch.check(model)?;
    SizeError::check("out", out.len(), model.rigid.bodies.len())?;
    known.move_frames(&mut scratch);
    for ((body, s), v) in model.rigid.bodies.iter().zip(&*scratch.bodies).zip(out) {
        *v = body.frame.map(T::from_param).motion(s.a);
    }
    Ok(())
}

impl<T: Scalar> Energy<T> {
    /// Adds a rigid body of this inertia, pose in the world and twist.
    fn add(&mut self, gravity: Vec3<T>, inertia: SpatialInertia<T>, pose: Transform<T>, v: Motion<T>) {
        // T = ½ vᵀ I v,   V = −m g·c
        self.kinetic += v.dot(inertia.momentum(v)) * T::from_f64(0.5);
        let moment = pose.rot.transpose_mul(inertia.first_moment) + pose.pos.scale(inertia.mass);
        self.gravity -= gravity.dot(moment);
    }
}

impl<T: Scalar> Known<'_, T> {
    fn joint_state(&self, body: &Body<T::Param>) -> JointState<T> {
        let v = body.v_index();
        JointState { q: self.q(body), qd: self.qd(body), theta: self.state.theta[v], thetad: self.state.thetad[v] }
    }

    /// Poses of all bodies in the world, and in the place of accelerations the twists of bodies and stations.
    fn move_frames(&self, scratch: &mut FlexibleScratch<T>) {
        self.outward(scratch);
        for (i, body) in self.model.rigid.bodies.iter().enumerate() {
            let (pose, v) = if body.joint == JointKind::Floating {
                let at = RootMotion::<T>::of(self.state.q, self.state.qd);
                (Transform { rot: at.rot, pos: at.pos }, at.v)
            } else {
                let x = self.across(i, &scratch.bodies[i]);
                let parent = match (self.model.seats[i].parent, body.parent()) {
                    (Some(station), Some(parent)) => {
                        let station = &scratch.stations[usize::from(station)];
                        (station.x.after(scratch.bodies[parent].pose), station.a)
                    }
                    (_, Some(parent)) => (scratch.bodies[parent].pose, scratch.bodies[parent].a),
                    (_, None) => (Transform::identity(), Motion::zero()),
                };
                (x.after(parent.0), body.joint.moved(x.motion(parent.1), self.qd(body)))
            };
            (scratch.bodies[i].pose, scratch.bodies[i].a) = (pose, v);
            let Some(link) = self.model.link_of(i) else { continue };
            for (k, station) in scratch.stations[link.station_range()].iter_mut().enumerate() {
                let columns = scratch.shapes[link.shape_range(k)].iter().zip(&self.etad[link.mode_range()]);
                station.a = columns.fold(station.x.motion(v), |sum, (column, etad)| sum + column.scale(*etad));
            }
        }
    }
}
