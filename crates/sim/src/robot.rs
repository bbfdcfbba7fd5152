//! A robot as loaded from files: the description in the user's frames, names, frames, and where every number came from.

use crate::bending::Lowered;
use crate::error::{Error, Warning};
use crate::flexible::{Flexible, Place};
use gyroflex::Scalar;
use gyroflex::dynamics::Hold;
use gyroflex::model::{Body, BodySpec, Fidelity, FlexibleModel, Knot, Model, RobotSpec};
use gyroflex::spatial::{SpatialInertia, Transform, Vec3};

/// A loaded robot.
#[derive(Clone, Debug)]
pub struct Robot {
    /// The robot's name.
    pub name: String,
    /// One entry per moving body (and joint), parents before children; a floating root is entry 0.
    pub joints: Vec<Joint>,
    /// The description the core lowers, one entry per joint.
    pub bodies: Vec<BodySpec>,
    /// Points of all spring tables.
    pub spring_tables: Vec<[f64; 2]>,
    /// Acceleration of gravity in world axes [m/s²].
    pub gravity: Vec3<f64>,
    /// The model commands use unless told otherwise.
    pub fidelity: Fidelity,
    /// Every URDF link, moving or fused, in the order of the file.
    pub links: Vec<Link>,
    /// Where every number of every joint came from.
    pub table: Vec<Entry>,
    /// What was ignored or assumed.
    pub warnings: Vec<Warning>,
    /// The files the robot was read from, the URDF first.
    pub sources: Vec<SourceFile>,
    /// The load it carries; the inertia of its body contains it.
    pub payload: Option<Payload>,
    /// Points that may touch the ground.
    pub contacts: Vec<ContactPoint>,
    /// What is held beside the joints, all the time.
    pub held: Vec<HeldPart>,
    /// The links that bend.
    pub flexible: Flexible,
}

/// A point that may touch the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPoint {
    /// Its name.
    pub name: String,
    /// Index of the body that it is on.
    pub body: usize,
    /// Where it is, in the body's link frame [m].
    pub point: Vec3<f64>,
}

/// A constraint that is always in force.
#[derive(Clone, Debug)]
pub struct HeldPart {
    /// Its name.
    pub name: String,
    /// What is held to what.
    pub hold: Hold<f64>,
    /// How fast errors are drawn back, critically damped [rad/s].
    pub stabilisation: f64,
}

/// A load fixed to a robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    /// Index of the link that carries it, in [`Robot::links`].
    pub link: usize,
    /// The body of that link; `None` rests on the world.
    pub body: Option<usize>,
    /// Its inertia about the origin of that body's link frame.
    pub inertia: SpatialInertia<f64>,
    /// Inertia of that body without it.
    pub unloaded: SpatialInertia<f64>,
    /// The station of a link that bends that it is on, and what is on it without the load.
    pub station: Option<(Place, SpatialInertia<f64>)>,
}

/// A joint by its names and limits.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in the URDF; `root` for a floating root.
    pub name: String,
    /// URDF type: `revolute`, `continuous`, `prismatic` or `floating`.
    pub urdf_type: String,
    /// Name of the parent link in the URDF; `world` for a floating root.
    pub parent_link: String,
    /// Name of the link it moves.
    pub child_link: String,
    /// Lower and upper position limit [rad or m], where given.
    pub limits: Option<[f64; 2]>,
    /// Largest velocity [rad/s or m/s], where given.
    pub max_velocity: Option<f64>,
    /// Largest torque the controller may ask for, link side [N m or N], where given.
    pub max_torque: Option<f64>,
}

/// A URDF link: a frame of a moving body, or of the world.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name in the URDF.
    pub name: String,
    /// The body it is part of; `None` if it does not move.
    pub body: Option<usize>,
    /// Pose of the link frame in that body's link frame, or in the world.
    pub placement: Transform<f64>,
    /// Name of the parent link in the URDF, for `/tf`; `None` for the root.
    pub parent: Option<String>,
}

/// One number of one joint, and its origin: a row of the merged table.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Joint name.
    pub joint: String,
    /// The key as in the drives YAML, e.g. `transmission.stiffness`.
    pub key: String,
    /// The value, as text.
    pub value: String,
    /// Unit, empty if none.
    pub unit: &'static str,
    /// File and line or rule it came from, e.g. `robot.yaml`, `robot.urdf:31 <dynamics>`, `default`.
    pub source: String,
}

/// The content of a file, kept for the log's attachments.
#[derive(Clone, Debug)]
pub struct SourceFile {
    /// File name without folders.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// Records in storage of our own, and a view of them on demand.
#[derive(Clone, Debug)]
pub struct OwnedModel {
    bodies: Vec<Body<f64>>,
    knots: Vec<Knot<f64>>,
    gravity: Vec3<f64>,
    flexible: Option<Box<Lowered>>,
    /// Which physics the records hold.
    pub fidelity: Fidelity,
}

/// Records of a robot in another scalar.
pub(crate) struct Records<F> {
    bodies: Vec<Body<F>>,
    knots: Vec<Knot<F>>,
    gravity: Vec3<F>,
}

impl<F: Scalar<Param = F>> Records<F> {
    /// The view the algorithms take.
    pub(crate) fn view(&self) -> Model<'_, F> {
        Model::new(&self.bodies, &self.knots, self.gravity)
    }
}

impl Robot {
    /// The description as the core takes it.
    pub fn spec(&self) -> RobotSpec<'_> {
        RobotSpec { bodies: &self.bodies, spring_tables: &self.spring_tables, gravity: self.gravity }
    }

    /// Lowers the robot to the records of one model.
    ///
    /// # Errors
    /// Names the joint and the link that are not physical.
    pub fn model(&self, fidelity: Fidelity) -> Result<OwnedModel, Error> {
        let spec = self.spec();
        let mut bodies = vec![Body::empty(); self.bodies.len()];
        let mut knots = vec![Knot::EMPTY; spec.knots_needed()];
        let rigid = spec.lower(fidelity, &mut bodies, &mut knots).map_err(|e| self.model_error(e))?;
        let flexible = match self.flexible.is_empty() {
            true => None,
            false => {
                let lowered = Lowered::new(&self.flexible, &spec, rigid);
                Some(Box::new(lowered.map_err(|e| self.model_error(e))?))
            }
        };
        Ok(OwnedModel { bodies, knots, gravity: self.gravity, flexible, fidelity })
    }

    /// Puts a load on the robot in place of the one it carries: the index of the link that carries it in [`Robot::links`], and the
    /// load's inertia about the origin of that link's body. `None` takes the load off.
    pub fn set_payload(&mut self, load: Option<(usize, SpatialInertia<f64>)>) {
        if let Some(Payload { body: Some(body), unloaded, station, .. }) = self.payload.take() {
            self.bodies[body].inertia = unloaded;
            if let Some((place, before)) = station {
                self.flexible.links[place.link].stations[place.station].inertia = before;
            }
        }
        let Some((link, inertia)) = load else { return };
        let body = self.links[link].body;
        let unloaded = body.map_or(SpatialInertia::zero(), |b| self.bodies[b].inertia);
        if let Some(body) = body {
            self.bodies[body].inertia = unloaded + inertia;
        }
        let station = self.load_station(link, inertia);
        self.payload = Some(Payload { link, body, inertia, unloaded, station });
    }

    /// Puts a load on the station of a link that bends: where the fixed link that carries it is, or on the link itself next to the
    /// load's centre of mass. The station, and what was on it before.
    fn load_station(&mut self, link: usize, inertia: SpatialInertia<f64>) -> Option<(Place, SpatialInertia<f64>)> {
        let centre = if inertia.mass > 0.0 { inertia.first_moment.scale(1.0 / inertia.mass) } else { Vec3::zero() };
        let (link, x) = self.flexible.place_of(&self.links, link, centre)?;
        let flexure = &mut self.flexible.links[link];
        let station = flexure.station_at(x, "payload");
        let on_it = &mut flexure.stations[station].inertia;
        let before = *on_it;
        *on_it = before + inertia;
        Some((Place { link, station }, before))
    }

    /// Multiplies mass and inertia of a link, not those of the load on it, by a factor. Whether it has a mass.
    pub fn scale_mass(&mut self, body: usize, factor: f64) -> bool {
        let load = self.payload.map(|load| (load.link, load.inertia));
        self.set_payload(None);
        let own = self.bodies[body].inertia;
        self.bodies[body].inertia = own.map(|x| x * factor);
        if let Some(link) = self.flexible.of_body(Some(body)) {
            self.flexible.links[link].scale_mass(factor);
        }
        self.set_payload(load);
        own.mass > 0.0
    }

    /// Number of single-degree-of-freedom joints: all but a floating root.
    pub fn is_floating(&self) -> bool {
        self.joints.first().is_some_and(|j| j.urdf_type == "floating")
    }
}

impl OwnedModel {
    /// The view the algorithms take: of the robot whose links do not bend.
    pub fn view(&self) -> Model<'_, f64> {
        Model::new(&self.bodies, &self.knots, self.gravity)
    }

    /// The records of the robot whose links do not bend, every number rounded to another scalar.
    pub(crate) fn cast<F: Scalar<Param = F>>(&self) -> Records<F> {
        Records {
            bodies: self.bodies.iter().map(Body::cast).collect(),
            knots: self.knots.iter().map(Knot::cast).collect(),
            gravity: self.gravity.map(F::from_f64),
        }
    }

    /// The view that algorithms of flexible links take, where there are any.
    pub fn flexible(&self) -> Option<FlexibleModel<'_, f64>> {
        self.flexible.as_ref().map(|parts| parts.view(self.view()))
    }

    /// Name of the first link that bends.
    pub(crate) fn first_bending_link(&self) -> Option<&str> {
        self.flexible.as_ref().map(|parts| parts.link())
    }

    /// Length of `q`: of the joints, then of the modes.
    pub fn nq(&self) -> usize {
        self.flexible().map_or_else(|| self.view().nq(), |model| model.nq())
    }

    /// Length of every other vector over joints and modes.
    pub fn nv(&self) -> usize {
        self.flexible().map_or_else(|| self.view().nv(), |model| model.nv())
    }

    /// Sets gravity in world axes [m/s²].
    pub fn set_gravity(&mut self, gravity: Vec3<f64>) {
        self.gravity = gravity;
    }
}

impl Robot {
    /// Names the joint behind an error of the core.
    fn model_error(&self, e: gyroflex::model::ModelError) -> Error {
        let files: Vec<&str> = self.sources.iter().map(|s| s.name.as_str()).collect();
        crate::load::defect::explain(&e, self, files.join(", "))
    }
}
