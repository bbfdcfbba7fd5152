//! Pass 1, base to tips: velocities, and forces that are known from the state.

use super::across::Across;
use super::link::Deflected;
use super::scratch::{FlexibleBody, FlexibleScratch, FlexibleStation};
use super::station::move_station;
use crate::Scalar;
use crate::dynamics::aba_base::velocity_force;
use crate::dynamics::tree::RootMotion;
use crate::dynamics::{External, State};
use crate::model::{Body, FlexibleModel, JointKind, SizeError};
use crate::spatial::{ArticulatedInertia, Motion, Vec3};

/// What every algorithm of flexible links is given.
#[derive(Clone, Copy)]
pub(super) struct Known<'a, T: Scalar> {
    pub(super) model: &'a FlexibleModel<'a, T::Param>,
    pub(super) state: State<'a, T>,
    pub(super) ext: External<'a, T>,
    /// Modal coordinates and rates.
    pub(super) eta: &'a [T],
    pub(super) etad: &'a [T],
}

impl<'a, T: Scalar> Known<'a, T> {
    pub(super) fn of(
        model: &'a FlexibleModel<'a, T::Param>,
        state: State<'a, T>,
        ext: External<'a, T>,
    ) -> Result<Self, SizeError> {
        let (nq, nv) = (model.nq(), model.nv());
        SizeError::check("q", state.q.len(), nq)?;
        SizeError::check("qd", state.qd.len(), nv)?;
        SizeError::check("theta", state.theta.len(), nv)?;
        SizeError::check("thetad", state.thetad.len(), nv)?;
        if !ext.tau.is_empty() {
            SizeError::check("external tau", ext.tau.len(), nv)?;
        }
        if !ext.wrenches.is_empty() {
            SizeError::check("external wrenches", ext.wrenches.len(), model.rigid.bodies.len())?;
        }
        let (eta, etad) = (&state.q[model.rigid.nq..], &state.qd[model.rigid.nv..]);
        Ok(Self { model, state, ext, eta, etad })
    }

    /// Position of a joint of one degree of freedom.
    pub(super) fn q(&self, body: &Body<T::Param>) -> T {
        self.state.q[body.q_index()]
    }

    /// Velocity of the same.
    pub(super) fn qd(&self, body: &Body<T::Param>) -> T {
        self.state.qd[body.v_index()]
    }

    /// Across the joint of body `i`, which is not a floating root.
    pub(super) fn across(&self, i: usize, s: &FlexibleBody<T>) -> Across<T> {
        let body = &self.model.rigid.bodies[i];
        Across::of(body, s.theta, self.q(body))
    }

    /// What is said of the frame that the joint of body `i` sits on: of a station, of a body, or of the world.
    pub(super) fn of_parent<X>(
        &self,
        i: usize,
        scratch: &FlexibleScratch<T>,
        of: (impl Fn(&FlexibleStation<T>) -> X, impl Fn(&FlexibleBody<T>) -> X),
        world: X,
    ) -> X {
        of_frame(self.model.seats[i].parent, self.model.rigid.bodies[i].parent, scratch, of, world)
    }

    /// The same of the frame that carries the rotor of body `i`'s joint.
    pub(super) fn of_carrier<X>(
        &self,
        i: usize,
        scratch: &FlexibleScratch<T>,
        of: (impl Fn(&FlexibleStation<T>) -> X, impl Fn(&FlexibleBody<T>) -> X),
        world: X,
    ) -> X {
        of_frame(self.model.seats[i].rotor, self.model.rigid.bodies[i].carrier(), scratch, of, world)
    }

    /// Velocities of bodies and stations and what they need for them; motor and spring torques are not part of it.
    pub(super) fn outward(&self, scratch: &mut FlexibleScratch<T>) {
        let model = self.model;
        for (i, body) in model.rigid.bodies.iter().enumerate() {
            let mut s = FlexibleBody { ia: ArticulatedInertia::zero(), ..FlexibleBody::new() };
            if body.joint == JointKind::Floating {
                s.omega = RootMotion::<T>::of(self.state.q, self.state.qd).v.ang;
            } else {
                let (q, qd) = (self.q(body), self.qd(body));
                let (sin, cos) = body.angle(q).sin_cos();
                (s.theta.sin, s.theta.cos) = (sin, cos);
                let x = Across::of(body, s.theta, q);
                let parent = self.of_parent(i, scratch, (|p| p.omega, |p| p.omega), Vec3::zero());

                // ω = E ω_p + z q̇,   c = [ω × z q̇; E (ω_p × (ω_p × r))]
                s.omega = x.rotate(parent);
                let across = Vec3::new(s.omega.y * qd, -(s.omega.x * qd), T::zero());
                s.c.lin = x.centripetal(parent);
                match body.joint {
                    JointKind::Prismatic => s.c.lin += across + across,
                    _ => {
                        s.c.ang = across;
                        s.omega.z += qd;
                    }
                }
            }
            s.inertia = body.inertia.map(T::from_param);
            match model.link_of(i) {
                None => s.p = velocity_force(s.inertia, s.omega),
                Some(link) => {
                    let own = Deflected::<T::Param, T>::of(model, link, self.eta, self.etad);
                    let modes = &mut scratch.modes[link.mode_range()];
                    own.inertia(&mut s, modes);
                    own.velocity_forces(&mut s, modes);
                    let stations = scratch.stations[link.station_range()].iter_mut();
                    for (k, station) in stations.enumerate() {
                        let columns = &mut scratch.shapes[link.shape_range(k)];
                        move_station(model, link, k, s.omega, (self.eta, self.etad), station, columns);
                    }
                }
            }
            if let Some(wrench) = self.ext.wrenches.get(i) {
                s.p -= body.frame.map(T::from_param).inv_force(*wrench);
            }
            scratch.bodies[i] = s;
        }
    }

    /// Acceleration of body `i` from that of what it hangs on, its joint's being given; a floating root has its own.
    pub(super) fn accelerate(&self, i: usize, qdd: &[T], scratch: &mut FlexibleScratch<T>, base: Motion<T>) {
        let body = &self.model.rigid.bodies[i];
        if body.joint == JointKind::Floating {
            return;
        }
        let parent = self.of_parent(i, scratch, (|p| p.a, |p| p.a), base);
        let s = &mut scratch.bodies[i];
        // a = X a_p + c + S q̈
        s.a = body.joint.moved(self.across(i, s).motion(parent) + s.c, qdd[body.v_index()]);
    }

    /// Accelerations of the stations of body `i`.
    pub(super) fn accelerate_stations(&self, i: usize, scratch: &mut FlexibleScratch<T>) {
        let Some(link) = self.model.link_of(i) else { return };
        let (a, modes) = (scratch.bodies[i].a, &scratch.modes[link.mode_range()]);
        for (k, station) in scratch.stations[link.station_range()].iter_mut().enumerate() {
            // a_s = X_s a + c + Σ Φ_j η̈_j
            let columns = &scratch.shapes[link.shape_range(k)];
            let bent = columns.iter().zip(modes).fold(station.c, |sum, (column, mode)| sum + column.scale(mode.etadd));
            station.a = station.x.motion(a) + bent;
        }
    }
}

fn of_frame<T: Scalar, X>(
    station: Option<u16>,
    body: Option<u16>,
    scratch: &FlexibleScratch<T>,
    (of_station, of_body): (impl Fn(&FlexibleStation<T>) -> X, impl Fn(&FlexibleBody<T>) -> X),
    world: X,
) -> X {
    match (station, body) {
        (Some(station), _) => of_station(&scratch.stations[usize::from(station)]),
        (None, Some(body)) => of_body(&scratch.bodies[usize::from(body)]),
        (None, None) => world,
    }
}
