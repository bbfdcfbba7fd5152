//! From the user's link frames to those of the recursions: the records of flexible links.

use super::{AssumedMode, Defect, FlexibleLink, FlexibleModel, FlexibleRecords, Model, ModelError, RobotSpec, Seat};
use crate::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};

impl<'s> FlexibleRecords<'s> {
    /// Checks the records, turns them from the user's link frames into those of the recursions, in place, and joins them to the
    /// rigid model that `spec` was lowered to.
    ///
    /// The inertia that `spec` gives a flexible link is that of the whole link at rest, with what is fixed to its stations; a rotor
    /// of its own mass that the link carries moves to its joint's seat.
    ///
    /// # Errors
    /// [`ModelError`] names the body and what is wrong with it; the records are then of no further use.
    pub fn lower(self, spec: &RobotSpec<'_>, rigid: Model<'s, f64>) -> Result<FlexibleModel<'s, f64>, ModelError> {
        let Self { links, modes, pairs, stations, shapes, shortenings, seats } = self;
        let mut records = FlexibleRecords { links, modes, pairs, stations, shapes, shortenings, seats };
        records.number(rigid.bodies.len())?;
        records.check_seats(spec, &rigid)?;
        for l in 0..records.links.len() {
            let body = usize::from(records.links[l].body);
            records.check_numbers(&records.links[l]).map_err(|defect| ModelError { body, defect })?;
            records.turn(l, rigid.bodies[body].frame);
        }
        records.seat_rotors(spec, &rigid)?;
        for link in records.links.iter_mut() {
            // What is not fixed to a station bends with the link itself.
            let lumped = records.stations[link.station_range()]
                .iter()
                .fold(SpatialInertia::zero(), |sum, station| sum + station.inertia);
            link.inertia = minus(rigid.bodies[usize::from(link.body)].inertia, lumped);
        }
        let FlexibleRecords { links, modes, pairs, stations, shapes, shortenings, seats } = records;
        Ok(FlexibleModel { rigid, links, modes, pairs, stations, shapes, shortenings, seats })
    }

    /// Gives every link its places in the other records, which must be just as many.
    fn number(&mut self, bodies: usize) -> Result<(), ModelError> {
        let wrong = |body: usize, which| ModelError { body, defect: Defect::FlexibleRecords(which) };
        if self.seats.len() != bodies {
            return Err(wrong(0, "there is not one seat per body"));
        }
        self.seats.iter_mut().for_each(|seat| seat.link = None);
        let (mut mode, mut pair, mut station, mut shape, mut shortening) = (0, 0, 0, 0, 0);
        let mut before = None;
        for (l, link) in self.links.iter_mut().enumerate() {
            let body = usize::from(link.body);
            if body >= bodies || before.is_some_and(|b| b >= link.body) {
                return Err(wrong(body.min(bodies.saturating_sub(1)), "links are not in the order of their bodies"));
            }
            before = Some(link.body);
            (link.first_mode, link.first_pair, link.first_station) = (mode as u32, pair as u32, station as u32);
            (link.first_shape, link.first_shortening) = (shape as u32, shortening as u32);
            let (n, m) = (link.n(), usize::from(link.stations));
            (mode, pair, station, shape) = (mode + n, pair + n * n, station + m, shape + m * n);
            shortening += if link.stiffening { m * n * n } else { 0 };
            self.seats[body].link = Some(l as u16);
        }
        let counts = [
            (self.modes.len() == mode, "modes"),
            (self.pairs.len() == pair, "pairs of modes, n × n per link"),
            (self.stations.len() == station, "stations"),
            (self.shapes.len() == shape, "shapes, one per mode and station"),
            (self.shortenings.len() == shortening, "shortenings, n × n per station of a link with stiffening"),
        ];
        match counts.into_iter().find(|(fits, _)| !fits) {
            Some((_, which)) => Err(wrong(0, which)),
            None => Ok(()),
        }
    }

    /// Every joint and rotor on a flexible link needs a station of that link, and others must not name one.
    fn check_seats(&self, spec: &RobotSpec<'_>, rigid: &Model<'_, f64>) -> Result<(), ModelError> {
        for (i, body) in spec.bodies.iter().enumerate() {
            let Seat { parent, rotor, .. } = self.seats[i];
            let mount = body.drive.and_then(|drive| drive.rotor.mount.body);
            if !self.is_on(parent, body.parent) || !self.is_on(rotor, mount) {
                return Err(ModelError { body: i, defect: Defect::NoStation });
            }
            // What a rigidly geared rotor asks of its carrier must be asked of what the joint sits on.
            let apart = rigid.bodies[i].rigid_rotor().is_some() && rotor.is_some() && rotor != parent;
            if rigid.bodies[i].has_remote_rigid_rotor() || apart {
                return Err(ModelError { body: i, defect: Defect::RemoteRigidRotor });
            }
        }
        Ok(())
    }

    /// Whether `station` is one of body `b`'s, or neither is there.
    fn is_on(&self, station: Option<u16>, b: Option<usize>) -> bool {
        let link = b.and_then(|b| self.seats.get(b)?.link).map(|l| &self.links[usize::from(l)]);
        match (link, station) {
            (Some(link), Some(station)) => link.station_range().contains(&usize::from(station)),
            (None, None) => true,
            _ => false,
        }
    }

    fn check_numbers(&self, link: &FlexibleLink<f64>) -> Result<(), Defect> {
        let (n, pairs) = (link.n(), &self.pairs[link.pair_range()]);
        let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
        let matrix = |m: &Mat3<f64>| m.rows.iter().all(|row| finite(&row.to_array()));
        let modes = self.modes[link.mode_range()].iter().all(|m| finite(&m.momentum.to_array()) && matrix(&m.moments));
        let doubles = pairs.iter().all(|p| {
            let vector = finite(&p.shortening.to_array()) && finite(&[p.stiffness, p.damping]);
            vector && matrix(&p.moments) && matrix(&p.shortening_moments)
        });
        let stations = self.stations[link.station_range()].iter().all(|s| {
            let [a, b, c] = s.inertia.rotational.to_mat3().rows;
            let inertia = [s.inertia.first_moment, a, b, c].iter().all(|v| finite(&v.to_array()));
            finite(&s.position.to_array()) && s.inertia.mass.is_finite() && inertia
        });
        let stations_k = 0..usize::from(link.stations);
        let shapes = stations_k.clone().flat_map(|k| &self.shapes[link.shape_range(k)]);
        let shapes =
            shapes.fold(true, |all, s| all && finite(&s.displacement.to_array()) && finite(&s.rotation.to_array()));
        let mut shortenings = stations_k.flat_map(|k| &self.shortenings[link.shortening_range(k)]);
        let shortenings = shortenings.all(|s| finite(&s.to_array()));
        if !(modes && doubles && stations && shapes && shortenings) {
            return Err(Defect::NotFinite("a number of its modes or stations"));
        }
        for j in 0..n {
            let own = &pairs[j * n + j];
            let mass: f64 = own.moments.trace();
            for (what, value) in [("the modal mass", mass), ("the modal stiffness", own.stiffness)] {
                if value <= 0.0 {
                    return Err(Defect::NotPositive(what, value));
                }
            }
            if own.damping < 0.0 {
                return Err(Defect::Negative("the modal damping", own.damping));
            }
        }
        Ok(())
    }

    /// Into the axes of the recursions, from which `frame` leads to the link's.
    fn turn(&mut self, l: usize, frame: Transform<f64>) {
        let link = &self.links[l];
        let vector = |v: Vec3<f64>| frame.rot.transpose_mul(v);
        let tensor = |a: Mat3<f64>| frame.rot.transpose() * a * frame.rot;
        // ∫ (r + x) φᵀ = r (∫ φ)ᵀ + ∫ x φᵀ
        let about_origin = |a: Mat3<f64>, sum: Vec3<f64>| Mat3::outer(frame.pos, sum) + tensor(a);
        for mode in &mut self.modes[link.mode_range()] {
            let momentum = vector(mode.momentum);
            *mode = AssumedMode { momentum, moments: about_origin(mode.moments, momentum) };
        }
        for pair in &mut self.pairs[link.pair_range()] {
            pair.moments = tensor(pair.moments);
            pair.shortening = vector(pair.shortening);
            pair.shortening_moments = about_origin(pair.shortening_moments, pair.shortening);
        }
        for station in &mut self.stations[link.station_range()] {
            station.position = frame.point(station.position);
            station.inertia = station.inertia.seen_from_parent(frame);
            station.rotors = SymMat3::zero();
        }
        for k in 0..usize::from(link.stations) {
            for shape in &mut self.shapes[link.shape_range(k)] {
                shape.displacement = vector(shape.displacement);
                shape.rotation = vector(shape.rotation);
            }
            for s in &mut self.shortenings[link.shortening_range(k)] {
                *s = vector(*s);
            }
        }
    }

    /// Adds to a rotor's station what lowering added to its link, `I_r − J n nᵀ`. A rotor without mass is contained in what is
    /// fixed to its station.
    fn seat_rotors(&mut self, spec: &RobotSpec<'_>, rigid: &Model<'_, f64>) -> Result<(), ModelError> {
        for (i, body) in spec.bodies.iter().enumerate() {
            let (Some(station), Some(drive), Some(record)) = (self.seats[i].rotor, &body.drive, &rigid.bodies[i].drive)
            else {
                continue;
            };
            let Some(carrier) = record.rotor.mount() else { continue };
            let station = &mut self.stations[usize::from(station)];
            let own = SymMat3::outer(record.rotor.axis).scale(drive.rotor.inertia);
            if let Some(at_rest) = drive.rotor.at_rest() {
                station.inertia = station.inertia + at_rest.seen_from_parent(rigid.bodies[carrier].frame);
            }
            if record.elastic.is_some() {
                station.inertia.rotational = station.inertia.rotational - own;
                station.rotors += own;
                if !is_positive(station.inertia, own) {
                    return Err(ModelError { body: i, defect: Defect::RotorLargerThanLink });
                }
            }
        }
        Ok(())
    }
}

/// Whether an inertia resists turning about its centre of mass, of which `taken = J n nᵀ` has been taken out.
fn is_positive(i: SpatialInertia<f64>, taken: SymMat3<f64>) -> bool {
    // n·I_c n J = tr(I_c J n nᵀ), where I_c = I − m (c·c 1 − c cᵀ)
    let h = i.first_moment;
    let squares = SymMat3::diagonal(h.dot(h), h.dot(h), h.dot(h)) - SymMat3::outer(h);
    let about_com = if i.mass > 0.0 { i.rotational - squares.scale(1.0 / i.mass) } else { i.rotational };
    let along = (about_com.to_mat3() * taken.to_mat3()).trace();
    let scale = taken.to_mat3().trace();
    along >= -ROUNDING * scale * scale
}

/// Part of a spin inertia below which a negative inertia is rounding.
const ROUNDING: f64 = 1e-9;

fn minus(a: SpatialInertia<f64>, b: SpatialInertia<f64>) -> SpatialInertia<f64> {
    SpatialInertia {
        mass: a.mass - b.mass,
        first_moment: a.first_moment - b.first_moment,
        rotational: a.rotational - b.rotational,
    }
}
