//! The integrals over the modes of a beam that its dynamics are made of.

use super::profile::{Profile, pieces};
use super::quadrature::composite;
use super::shape::{BeamMode, Deflection, Inertia, Resistance, frequency, points_for};
use gyroflex::model::{AssumedMode, ModePair, StationShape};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// A straight beam along x, from its root at 0 to its tip, and the modes that its deflection is made of.
///
/// Cross-sections have no rotary inertia in bending (Cetinkunt & Book 1988, below eq. 14). Their polar inertia about the beam's axis
/// is that of material evenly around it: half of it counts across the axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    /// Length [m].
    pub length: f64,
    /// Mass per length [kg/m].
    pub mass_per_length: Profile,
    /// Polar moment of inertia per length, `ρ I_p` [kg m].
    pub polar_inertia_per_length: Profile,
    /// Its modes.
    pub modes: Vec<BeamMode>,
    /// Whether a bent beam is shorter than a straight one (geometric stiffening).
    pub stiffening: bool,
}

/// The integrals of a beam, in its own axes about its root or in those of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Integrals {
    /// One per mode.
    pub modes: Vec<AssumedMode<f64>>,
    /// One per pair of modes, by rows.
    pub pairs: Vec<ModePair<f64>>,
    /// Inertia of the straight beam.
    pub inertia: SpatialInertia<f64>,
}

/// What a mode is on its own, for reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeFigures {
    /// `K_jj` [N/m], in torsion [N m/rad].
    pub stiffness: f64,
    /// Modal mass of the beam [kg], in torsion [kg m²].
    pub mass: f64,
    /// The same with the body at the tip of a `clamped_mass` beam, or the lumped masses that a table counts.
    pub total_mass: f64,
    /// Natural frequency of stiffness and total mass [Hz].
    pub frequency: f64,
    /// Damping ratio at that frequency [–].
    pub damping_ratio: f64,
}

/// Modes that cannot be used together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeamError {
    /// The quadrature is too coarse for the modes: so many points would do.
    TooFewPoints(usize),
    /// A mode that is a sum of those before it, by its index.
    Dependent(usize),
    /// A mode that moves no mass, by its index.
    Massless(usize),
}

impl Beam {
    /// Its inertia over the length.
    pub fn inertia_per_length(&self) -> Inertia<'_> {
        Inertia { length: self.length, mass: &self.mass_per_length, polar: &self.polar_inertia_per_length }
    }

    /// How mode `j` moves the cross-section at `x`, in the beam's axes.
    pub fn section(&self, j: usize, x: f64) -> StationShape<f64> {
        let mode = &self.modes[j];
        let (value, slope) = (mode.shape.derivative(x, 0), mode.shape.derivative(x, 1));
        let displacement = mode.deflection.direction().scale(value);
        StationShape { displacement, rotation: mode.deflection.rotation(value, slope) }
    }

    /// How far modes `j` and `k` together draw the cross-section at `x` towards the root: `∫₀ˣ φ'_j·φ'_k dξ` [1/m].
    pub fn shortening(&self, j: usize, k: usize, x: f64) -> f64 {
        let [a, b] = [j, k].map(|i| &self.modes[i]);
        if !self.stiffening || a.deflection != b.deflection || !a.deflection.bends() {
            return 0.0;
        }
        let breaks = pieces(0.0, x, a.shape.breaks().chain(b.shape.breaks()));
        let rule = composite(&breaks, points_for(a.shape.eigenvalue().max(b.shape.eigenvalue())));
        rule.iter().map(|[xi, w]| w * a.shape.derivative(*xi, 1) * b.shape.derivative(*xi, 1)).sum()
    }

    /// Points per smooth piece that integrate the products of its modes to the last digits.
    pub fn enough_points(&self) -> usize {
        self.modes.iter().map(|m| points_for(m.shape.eigenvalue())).max().unwrap_or(2)
    }

    /// The integrals by quadrature with `points` on every piece between points of its tables, in the beam's axes about its root.
    pub fn integrals(&self, points: usize) -> Integrals {
        let n = self.modes.len();
        let zero = AssumedMode { momentum: Vec3::zero(), moments: Mat3::zero() };
        let mut modes = vec![zero; n];
        let none = ModePair {
            moments: Mat3::zero(),
            stiffness: 0.0,
            damping: 0.0,
            shortening: Vec3::zero(),
            shortening_moments: Mat3::zero(),
        };
        let mut pairs = vec![none; n * n];
        let mut inertia = SpatialInertia::zero();
        let along = Vec3::new(1.0, 0.0, 0.0);
        for [x, w] in composite(&self.breaks(), points) {
            let (mass, polar) = (w * self.mass_per_length.at(x), w * self.polar_inertia_per_length.at(x));
            inertia = inertia + slice(mass, polar, x);
            let beyond = if self.stiffening { self.mass_per_length.beyond(x, self.length) } else { [0.0; 2] };
            let at: Vec<Fields> = self.modes.iter().map(|mode| Fields::of(mode, x)).collect();
            for (j, a) in at.iter().enumerate() {
                modes[j].momentum += a.displacement.scale(mass);
                let moments = Mat3::outer(along, a.displacement).scale(mass * x);
                modes[j].moments = modes[j].moments + moments + twisted(a.twist * polar);
                for (k, b) in at.iter().enumerate() {
                    let pair = &mut pairs[j * n + k];
                    let turning = across().scale(0.5 * polar * a.twist * b.twist);
                    pair.moments = pair.moments + Mat3::outer(a.displacement, b.displacement).scale(mass) + turning;
                    if self.modes[j].deflection != self.modes[k].deflection {
                        continue;
                    }
                    // K_jk (eq. 29.a–d); modes with a frequency of their own are orthogonal
                    if let [Some(stiffness), Some(_)] = [a.stiffness, b.stiffness] {
                        pair.stiffness += w * stiffness * a.strain * b.strain;
                    }
                    // ∫ s dm and ∫ x s dm, the order of the two integrals changed
                    let slopes = w * a.slope * b.slope;
                    pair.shortening += along.scale(-slopes * beyond[0]);
                    let moments = Mat3::outer(along, along).scale(-slopes * beyond[1]);
                    pair.shortening_moments = pair.shortening_moments + moments;
                }
            }
        }
        for j in 0..n {
            let mass = pairs[j * n + j].moments.trace() + self.modes[j].lumped;
            if let Resistance::Frequency(f) = self.modes[j].resistance {
                pairs[j * n + j].stiffness = mass * (2.0 * PI * f).powi(2);
            }
            // D = 2 ζ ω m
            let stiffness = pairs[j * n + j].stiffness;
            pairs[j * n + j].damping = 2.0 * self.modes[j].damping_ratio * (stiffness * mass).sqrt();
        }
        Integrals { modes, pairs, inertia }
    }

    /// Stiffness, mass and frequency of mode `j` on its own.
    pub fn figures(&self, j: usize, integrals: &Integrals) -> ModeFigures {
        let pair = &integrals.pairs[j * self.modes.len() + j];
        let (stiffness, mass) = (pair.stiffness, pair.moments.trace());
        let total_mass = mass + self.modes[j].lumped;
        // D = 2 ζ √(K m)
        let damping_ratio = 0.5 * pair.damping / (stiffness * total_mass).sqrt();
        ModeFigures { stiffness, mass, total_mass, frequency: frequency(stiffness, total_mass), damping_ratio }
    }

    /// Checks that the modes can be used together and that `points` are enough to integrate them.
    ///
    /// # Errors
    /// Modes without mass or that depend on each other, and how many points it takes.
    pub fn check(&self, points: usize) -> Result<(), BeamError> {
        let enough = points.max(self.enough_points());
        let exact = self.integrals(2 * enough);
        let fits = |points: usize| differ(&self.integrals(points), &exact) < ACCURACY;
        if !fits(points) {
            let needed = (points + 1..=enough).find(|p| fits(*p)).unwrap_or(enough);
            return Err(BeamError::TooFewPoints(needed));
        }
        let n = self.modes.len();
        let mass = DMatrix::from_fn(n, n, |j, k| exact.pairs[j * n + k].moments.trace());
        if let Some(j) = (0..n).find(|j| mass[(*j, *j)] <= 0.0) {
            return Err(BeamError::Massless(j));
        }
        let gram = DMatrix::from_fn(n, n, |j, k| mass[(j, k)] / (mass[(j, j)] * mass[(k, k)]).sqrt());
        let dependent = (1..=n).find(|j| gram.view((0, 0), (*j, *j)).symmetric_eigenvalues().min() < INDEPENDENT);
        dependent.map_or(Ok(()), |j| Err(BeamError::Dependent(j - 1)))
    }

    fn breaks(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.mass_per_length.breaks().chain(self.polar_inertia_per_length.breaks()).collect();
        for mode in &self.modes {
            all.extend(mode.shape.breaks());
            if let Resistance::Stiffness(profile) = &mode.resistance {
                all.extend(profile.breaks());
            }
        }
        pieces(0.0, self.length, all.into_iter())
    }
}

/// What one mode does at a point of the beam, per unit of its coordinate.
struct Fields {
    /// Displacement of the axis.
    displacement: Vec3<f64>,
    /// Turning about the axis.
    twist: f64,
    /// Slope of a bent axis; zero for rods.
    slope: f64,
    /// Curvature, or the slope of a rod.
    strain: f64,
    /// What resists it; `None` for a mode with a frequency of its own.
    stiffness: Option<f64>,
}

impl Fields {
    fn of(mode: &BeamMode, x: f64) -> Self {
        let (deflection, shape) = (mode.deflection, &mode.shape);
        let value = shape.derivative(x, 0);
        Self {
            displacement: deflection.direction().scale(value),
            twist: if deflection == Deflection::Torsion { value } else { 0.0 },
            slope: if deflection.bends() { shape.derivative(x, 1) } else { 0.0 },
            strain: shape.derivative(x, deflection.strain_order()),
            stiffness: match &mode.resistance {
                Resistance::Stiffness(profile) => Some(profile.at(x)),
                Resistance::Frequency(_) => None,
            },
        }
    }
}

/// Relative error of the integrals that a quadrature may make.
const ACCURACY: f64 = 1e-9;
/// Smallest eigenvalue of the modes' mass matrix, scaled to ones on its diagonal.
const INDEPENDENT: f64 = 1e-9;

impl Integrals {
    /// The same integrals in the axes of a frame in which the beam's frame is at `placement`, about its origin.
    pub fn seen_from_parent(&self, placement: Transform<f64>) -> Self {
        let turn = placement.rotation();
        let tensor = |a: Mat3<f64>| turn * a * turn.transpose();
        let root = placement.point(Vec3::zero());
        let modes = self.modes.iter().map(|mode| {
            let momentum = turn * mode.momentum;
            AssumedMode { momentum, moments: Mat3::outer(root, momentum) + tensor(mode.moments) }
        });
        let pairs = self.pairs.iter().map(|pair| {
            let shortening = turn * pair.shortening;
            ModePair {
                moments: tensor(pair.moments),
                shortening,
                shortening_moments: Mat3::outer(root, shortening) + tensor(pair.shortening_moments),
                ..*pair
            }
        });
        Self { modes: modes.collect(), pairs: pairs.collect(), inertia: self.inertia.seen_from_parent(placement) }
    }
}

impl Integrals {
    /// Multiplies every mass by a factor; stiffness and damping stay.
    pub(crate) fn scale_mass(&mut self, factor: f64) {
        for mode in &mut self.modes {
            *mode = AssumedMode { momentum: mode.momentum.scale(factor), moments: mode.moments.scale(factor) };
        }
        for pair in &mut self.pairs {
            pair.moments = pair.moments.scale(factor);
            pair.shortening = pair.shortening.scale(factor);
            pair.shortening_moments = pair.shortening_moments.scale(factor);
        }
        self.inertia = self.inertia.map(|x| x * factor);
    }
}

/// The largest difference of masses and stiffnesses, as part of the modes' own.
fn differ(a: &Integrals, b: &Integrals) -> f64 {
    let n = b.modes.len();
    let mut most = 0.0_f64;
    for j in 0..n {
        for k in 0..n {
            let [p, q] = [a, b].map(|i| &i.pairs[j * n + k]);
            let own = |f: fn(&ModePair<f64>) -> f64| (f(&b.pairs[j * n + j]) * f(&b.pairs[k * n + k])).sqrt();
            let (mass, stiffness) = (own(|p| p.moments.trace()), own(|p| p.stiffness));
            most = most.max((p.moments.trace() - q.moments.trace()).abs() / mass);
            most = most.max((p.stiffness - q.stiffness).abs() / stiffness);
        }
    }
    most
}

/// Inertia of a slice of the beam about its root.
fn slice(mass: f64, polar: f64, x: f64) -> SpatialInertia<f64> {
    SpatialInertia::from_com(mass, Vec3::new(x, 0.0, 0.0), SymMat3::diagonal(polar, 0.5 * polar, 0.5 * polar))
}

/// `∫ r φᵀ dm` of a slice that turns about x, per turn: `φ = e_x × r`.
fn twisted(polar: f64) -> Mat3<f64> {
    let zero = Vec3::zero();
    Mat3::from_rows(zero, Vec3::new(0.0, 0.0, 0.5 * polar), Vec3::new(0.0, -0.5 * polar, 0.0))
}

/// The projection across x.
fn across() -> Mat3<f64> {
    SymMat3::diagonal(0.0, 1.0, 1.0).to_mat3()
}
