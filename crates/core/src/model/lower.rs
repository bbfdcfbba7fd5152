//! From the user's description to records: frames turned, rotors lumped.

use super::body::WORLD;
use super::{
    Body, BodySpec, Defect, Drive, DriveSpec, Elastic, Fidelity, JointKind, Knot, Model, ModelError, RobotSpec, Rotor,
    Spring, SpringSpec, TransmissionSpec,
};
use crate::Scalar;
use crate::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};

impl RobotSpec<'_> {
    /// How many spring knots [`RobotSpec::lower`] writes at most.
    pub fn knots_needed(&self) -> usize {
        let knots = |body: &BodySpec| match body.drive?.transmission {
            TransmissionSpec::Elastic { spring: SpringSpec::Table { len, .. }, .. } => len.checked_mul(2),
            _ => None,
        };
        self.bodies.iter().filter_map(knots).sum()
    }

    /// Checks the description and writes one record per body, and the pieces of all spring tables, into the caller's
    /// storage. Records beyond those needed are left alone.
    ///
    /// # Errors
    /// [`ModelError`] names the body and what is wrong with it. Nothing that passes can make an algorithm fail.
    pub fn lower<'s>(
        &self,
        fidelity: Fidelity,
        bodies: &'s mut [Body<f64>],
        knots: &'s mut [Knot<f64>],
    ) -> Result<Model<'s, f64>, ModelError> {
        self.validate()?;
        let n = self.bodies.len();
        if bodies.len() < n {
            return Err(ModelError { body: bodies.len(), defect: Defect::TooFewBodies });
        }
        let (mut iq, mut iv, mut used_knots) = (0, 0, 0);
        for (i, spec) in self.bodies.iter().enumerate() {
            let parent_frame = spec.parent.map_or(Transform::identity(), |p| bodies[p].frame);
            let frame = link_frame(spec);
            // From the parent's turned frame to its link frame, on to the joint frame, and into this body's turned frame.
            let tree = frame.inverse().after(spec.placement.after(parent_frame));
            let drive = match &spec.drive {
                None => None,
                Some(drive) => Some(
                    self.lower_drive(drive, fidelity, &bodies[..i], knots, &mut used_knots)
                        .map_err(|defect| ModelError { body: i, defect })?,
                ),
            };
            bodies[i] = Body {
                parent: spec.parent.map_or(WORLD, |p| p as u16),
                joint: spec.joint,
                iq,
                iv,
                tree,
                inertia: spec.inertia.seen_from_parent(frame),
                frame,
                friction: spec.friction,
                drive,
            };
            iq += spec.joint.nq() as u16;
            iv += spec.joint.nv() as u16;
        }
        self.lump_rotors(fidelity, bodies);
        Ok(Model::new(&bodies[..n], &knots[..used_knots], self.gravity))
    }

    fn lower_drive(
        &self,
        spec: &DriveSpec,
        fidelity: Fidelity,
        bodies: &[Body<f64>],
        knots: &mut [Knot<f64>],
        used_knots: &mut usize,
    ) -> Result<Drive<f64>, Defect> {
        let (mount, n) = (spec.rotor.mount, spec.gear_ratio);
        let axis = match mount.body {
            Some(b) if fidelity.is_gyroscopic() => {
                bodies[b].frame.rot.transpose_mul(mount.placement.rotation() * mount.axis)
            }
            _ => Vec3::zero(),
        };
        let reflected = n * n * spec.rotor.inertia;
        let rotor = Rotor {
            mount: mount.body.map_or(WORLD, |b| b as u16),
            axis,
            inertia: spec.rotor.inertia,
            gear_ratio: n,
            inv_gear_ratio: 1.0 / n,
            reflected_inertia: reflected,
            inv_reflected_inertia: 1.0 / reflected,
            friction: spec.friction,
        };
        let elastic = match spec.transmission {
            TransmissionSpec::Elastic { spring, damping, error } if fidelity.is_elastic() => Some(Elastic {
                spring: self.lower_spring(spring, knots, used_knots)?,
                damping,
                error: (error.amplitude != 0.0).then_some(error),
            }),
            _ => None,
        };
        Ok(Drive { rotor, elastic })
    }

    /// Adds every rotor at rest to the body that carries it. What an elastic rotor's own equation covers, `J n nᵀ`, is
    /// taken out again: `I_eff = I + I_r − J n nᵀ` (PHYSICS §3).
    fn lump_rotors(&self, fidelity: Fidelity, bodies: &mut [Body<f64>]) {
        for (i, spec) in self.bodies.iter().enumerate() {
            let (Some(drive), Some(record)) = (&spec.drive, bodies[i].drive) else { continue };
            let Some(mount) = drive.rotor.mount.body else { continue };
            let (spin, place) = (drive.rotor.inertia, drive.rotor.mount.placement);
            let axis = place.rotation() * drive.rotor.mount.axis;
            if let Some(rotor) = drive.rotor.body {
                // I_r = J_t (1 − n nᵀ) + J n nᵀ about the rotor's centre.
                let jt = rotor.transverse_inertia;
                let about_centre = SymMat3::diagonal(jt, jt, jt) + SymMat3::outer(axis).scale(spin - jt);
                let at_rest = SpatialInertia::from_com(rotor.mass, place.pos, about_centre);
                bodies[mount].inertia = bodies[mount].inertia + at_rest.seen_from_parent(bodies[mount].frame);
            }
            if record.elastic.is_some() && fidelity.is_gyroscopic() {
                let own = SymMat3::outer(record.rotor.axis).scale(-spin);
                bodies[mount].inertia.rotational += own;
            }
        }
    }

    fn lower_spring(&self, spec: SpringSpec, knots: &mut [Knot<f64>], used: &mut usize) -> Result<Spring<f64>, Defect> {
        match spec {
            SpringSpec::Polynomial { stiffness, cubic } => Ok(Spring { stiffness, cubic, first_knot: 0, knots: 0 }),
            SpringSpec::Table { first, len } => {
                let table = &self.spring_tables[first..first + len];
                let start = *used;
                let written = super::spring::lower_table(table, knots.get_mut(start..).unwrap_or(&mut []))
                    .ok_or(Defect::TooFewKnots)?;
                *used += written;
                let mut spring = Spring { stiffness: 0.0, cubic: 0.0, first_knot: start as u16, knots: written as u16 };
                spring.stiffness = spring.slope(0.0, knots);
                Ok(spring)
            }
        }
    }
}

impl Body<f64> {
    /// A placeholder to fill storage with before lowering.
    pub fn empty() -> Self {
        Self {
            parent: WORLD,
            joint: JointKind::Revolute,
            iq: 0,
            iv: 0,
            tree: Transform::identity(),
            inertia: SpatialInertia::zero(),
            frame: Transform::identity(),
            friction: super::Friction::none(),
            drive: None,
        }
    }
}

/// From the frame the recursions use, its z-axis along the joint axis, to the user's link frame.
fn link_frame(spec: &BodySpec) -> Transform<f64> {
    if spec.joint == JointKind::Floating {
        return Transform::identity();
    }
    let z = spec.axis.scale(1.0 / Scalar::sqrt(spec.axis.dot(spec.axis)));
    // The coordinate axis least along z makes x; an axis that is a coordinate axis gives a matrix of exact zeros and ones.
    let a = z.map(f64::abs);
    let e = if a.x <= a.y && a.x <= a.z {
        Vec3::new(1.0, 0.0, 0.0)
    } else if a.y <= a.z {
        Vec3::new(0.0, 1.0, 0.0)
    } else {
        Vec3::new(0.0, 0.0, 1.0)
    };
    let across = e - z.scale(e.dot(z));
    let x = across.scale(1.0 / Scalar::sqrt(across.dot(across)));
    let turned = Mat3::from_rows(x, z.cross(x), z);
    Transform { rot: turned.transpose(), pos: Vec3::zero() }
}
