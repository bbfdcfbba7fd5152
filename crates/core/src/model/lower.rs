//! From the user's description to records: frames turned, rotors lumped.

use super::{
    Body, BodySpec, Defect, Drive, DriveSpec, Elastic, Fidelity, JointKind, Knot, Model, ModelError, Placement,
    RobotSpec, Rotor, Spring, SpringSpec, TransmissionSpec,
};
use crate::Scalar;
use crate::spatial::{Branch, Mat3, SpatialInertia, SymMat3, Transform, Turn, Vec3};

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
            let frame = self.link_frame(i);
            let parent_frame = spec.parent.map_or(Transform::identity(), |p| bodies[p].frame);
            // From the parent's turned frame to its link frame, on to the joint frame, and into this body's turned frame.
            let tree = frame.inverse().after(spec.placement.after(parent_frame));
            let drive = match &spec.drive {
                None => None,
                Some(drive) => Some(
                    self.lower_drive(drive, fidelity, &bodies[..i], knots, &mut used_knots)
                        .map_err(|defect| ModelError { body: i, defect })?,
                ),
            };
            let placement = placement(
                tree,
                i > 0 && spec.parent == Some(i - 1) && bodies[i - 1].joint != JointKind::Floating,
                spec.placement.pos.norm() + parent_frame.pos.norm() + frame.pos.norm(),
            );
            bodies[i] = Body {
                parent: spec.parent.map(|p| p as u16),
                joint: spec.joint,
                q_index: iq,
                v_index: iv,
                shared: false,
                placement,
                inertia: spec.inertia.seen_from_parent(frame),
                rotors: SymMat3::zero(),
                frame,
                friction: spec.friction,
                drive,
            };
            // A parent, and a rotor's carrier, that is not simply the body before.
            let carrier = drive.and_then(|d| d.rotor.mount());
            let parent = spec.parent.filter(|_| placement.branch.is_some());
            let carrier = carrier.filter(|m| m + 1 != i || spec.parent != Some(*m));
            for other in [parent, carrier].into_iter().flatten() {
                bodies[other].shared = true;
            }
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
            mount: mount.body.map(|b| b as u16),
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
            if let Some(at_rest) = drive.rotor.at_rest() {
                bodies[mount].inertia = bodies[mount].inertia + at_rest.seen_from_parent(bodies[mount].frame);
            }
            if record.elastic.is_some() && fidelity.is_gyroscopic() {
                let own = SymMat3::outer(record.rotor.axis).scale(drive.rotor.inertia);
                bodies[mount].inertia.rotational = bodies[mount].inertia.rotational - own;
                bodies[mount].rotors += own;
            }
        }
    }

    fn lower_spring(&self, spec: SpringSpec, knots: &mut [Knot<f64>], used: &mut usize) -> Result<Spring<f64>, Defect> {
        match spec {
            SpringSpec::Polynomial { stiffness, cubic } => {
                Ok(Spring { stiffness, cubic, straight: cubic == 0.0, first_knot: 0, knots: 0 })
            }
            SpringSpec::Table { first, len } => {
                let table = &self.spring_tables[first..first + len];
                let start = *used;
                let written = super::spring::lower_table(table, knots.get_mut(start..).unwrap_or(&mut []))
                    .ok_or(Defect::TooFewKnots)?;
                *used += written;
                let mut spring = Spring {
                    stiffness: 0.0,
                    cubic: 0.0,
                    straight: false,
                    first_knot: start as u16,
                    knots: written as u16,
                };
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
            parent: None,
            joint: JointKind::Revolute,
            q_index: 0,
            v_index: 0,
            shared: false,
            placement: Placement { branch: None, a: 0.0, alpha: Turn::none(), d: 0.0, zero: 0.0 },
            inertia: SpatialInertia::zero(),
            rotors: SymMat3::zero(),
            frame: Transform::identity(),
            friction: super::Friction::none(),
            drive: None,
        }
    }
}

impl RobotSpec<'_> {
    /// From the frame the recursions use to the user's link frame: z-axis along the joint axis, x-axis along the common
    /// normal with the axis of the first joint that hangs on the link, origin where that begins.
    fn link_frame(&self, i: usize) -> Transform<f64> {
        let spec = &self.bodies[i];
        if spec.joint == JointKind::Floating {
            return Transform::identity();
        }
        let z = unit(spec.axis);
        let (normal, foot) = match self.bodies.iter().find(|b| b.parent == Some(i)) {
            Some(next) => common_normal(z, next.placement.pos, unit(next.placement.rotation() * next.axis)),
            None => (Vec3::zero(), 0.0),
        };
        // Without a normal, the coordinate axis least along z makes one, so that an axis that is a coordinate axis gives a
        // matrix of exact zeros and ones.
        let a = z.map(f64::abs);
        let e = if normal != Vec3::zero() {
            normal
        } else if a.x <= a.y && a.x <= a.z {
            Vec3::new(1.0, 0.0, 0.0)
        } else if a.y <= a.z {
            Vec3::new(0.0, 1.0, 0.0)
        } else {
            Vec3::new(0.0, 0.0, 1.0)
        };
        let x = unit(e - z.scale(e.dot(z)));
        let turned = Mat3::from_rows(x, z.cross(x), z);
        Transform { rot: turned.transpose(), pos: Vec3::new(0.0, 0.0, -foot) }
    }
}

/// Sine of an angle below which axes count as parallel, and a direction as one of the frame's own [–].
const PARALLEL: f64 = 1e-15;

/// Part of a distance below which it counts as none [–].
const NEGLIGIBLE: f64 = 8.0 * f64::EPSILON;

/// Distance of parallel axes, as part of that of the joints on them, below which its direction is left to rounding [–].
const ALIGNED: f64 = 1e-9;

/// How many times as far as the next joint a common normal may begin [–]: those of nearly parallel axes begin anywhere, and
/// inertias about a far point lose digits.
const NEAR: f64 = 4.0;

/// The common normal of the axis `z` through the origin and of the axis `next` through `p`, of any length, zero if there is no
/// telling; and where on `z` it begins [m].
fn common_normal(z: Vec3<f64>, p: Vec3<f64>, next: Vec3<f64>) -> (Vec3<f64>, f64) {
    let normal = z.cross(next);
    let sine = normal.norm();
    if sine > PARALLEL {
        let foot = p.cross(next).dot(normal) / (sine * sine);
        return (normal, if f64::abs(foot) <= NEAR * p.norm() { foot } else { 0.0 });
    }
    // Parallel axes have many: one through the origin.
    let across = p - z.scale(z.dot(p));
    if across.norm() > ALIGNED * p.norm() { (across, 0.0) } else { (Vec3::zero(), 0.0) }
}

/// `tree`, from parent to joint at `q = 0`, as `Rz(zero) Tz(d) Rx(α) Tx(a)` after a branch, which a joint that continues a chain
/// does without if the common normal of the axes is the parent's x-axis. `scale` is the size of the numbers behind `tree` [m].
fn placement(tree: Transform<f64>, chained: bool, scale: f64) -> Placement<f64> {
    let z = tree.rot.rows[2];
    // The joint axis is (sin α sin β, −sin α cos β, cos α) in the parent's axes.
    let across = Scalar::sqrt(z.x * z.x + z.y * z.y);
    let beta = if chained || across <= PARALLEL || f64::abs(z.x) <= PARALLEL {
        Turn::none()
    } else {
        Turn { sin: z.x / across, cos: -z.y / across }
    };
    let sin = if across <= PARALLEL { 0.0 } else { beta.z(z).y };
    // Right angles are exact.
    let alpha = match () {
        _ if sin == 0.0 => Turn { sin: 0.0, cos: if z.z < 0.0 { -1.0 } else { 1.0 } },
        _ if f64::abs(z.z) <= PARALLEL => Turn { sin: if sin < 0.0 { 1.0 } else { -1.0 }, cos: 0.0 },
        _ => Turn { sin: -sin, cos: z.z },
    };
    // The joint's origin is (a, −d sin α, d cos α) beyond the branch: what is left is the branch's.
    let exact = |x: f64| if f64::abs(x) <= NEGLIGIBLE * scale { 0.0 } else { x };
    let origin = beta.z(tree.pos);
    let d = exact(alpha.cos * origin.z - alpha.sin * origin.y);
    let shift = Vec3::new(0.0, exact(origin.y + d * alpha.sin), exact(origin.z - d * alpha.cos));
    // The common normal, which is x in the axes turned by β, seen from the joint: (cos zero, −sin zero, 0).
    let normal = tree.rot * beta.z_back(Vec3::new(1.0, 0.0, 0.0));
    Placement {
        branch: (!chained || shift != Vec3::zero()).then_some(Branch { turn: beta, shift }),
        a: exact(origin.x),
        alpha,
        d,
        zero: Scalar::atan2(-normal.y, normal.x),
    }
}

fn unit(v: Vec3<f64>) -> Vec3<f64> {
    v.scale(1.0 / v.norm())
}
