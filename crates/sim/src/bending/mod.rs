//! Robots whose links bend, as the rest of the crate sees them: records in their lowered form, cross-sections by name, and what is
//! refused to them.

mod section;

pub use section::{CrossSection, Tip};

use crate::beam::Deflection;
use crate::error::{Error, ErrorKind};
use crate::flexible::{Flexible, FlexibleTables};
use crate::robot::{OwnedModel, Robot};
use gyroflex::model::{FlexibleModel, Model, ModelError, RobotSpec};

/// The records of links that bend, as the recursions take them.
#[derive(Clone, Debug)]
pub(crate) struct Lowered {
    tables: FlexibleTables,
    /// The first link that bends, to name it in refusals.
    link: String,
}

impl Lowered {
    pub(crate) fn new(flexible: &Flexible, spec: &RobotSpec<'_>, rigid: Model<'_, f64>) -> Result<Self, ModelError> {
        let mut tables = flexible.tables();
        tables.records().lower(spec, rigid)?;
        let link = flexible.links.first().map_or_else(String::new, |l| l.name.clone());
        Ok(Self { tables, link })
    }

    pub(crate) fn link(&self) -> &str {
        &self.link
    }

    /// The view the algorithms take.
    pub(crate) fn view<'a>(&'a self, rigid: Model<'a, f64>) -> FlexibleModel<'a, f64> {
        let FlexibleTables { links, modes, pairs, stations, shapes, shortenings, seats } = &self.tables;
        FlexibleModel::new(rigid, links, modes, pairs, stations, shapes, shortenings, seats)
    }
}

impl Flexible {
    /// For each mode whether its coordinate is an angle, and not a length.
    pub fn turning(&self) -> Vec<bool> {
        let modes = self.links.iter().flat_map(|l| &l.beam.modes);
        modes.map(|m| m.deflection == Deflection::Torsion).collect()
    }
}

impl Robot {
    /// Names of the modal coordinates, which follow the joints in every vector.
    pub fn mode_names(&self) -> Vec<String> {
        self.flexible.mode_names().map(str::to_owned).collect()
    }

    /// Refuses a robot with links that bend, for `what` knows rigid ones only.
    ///
    /// # Errors
    /// Names the link, and what to do.
    pub fn refuse_bending(&self, what: &str, remedy: &str) -> Result<(), Error> {
        let Some(link) = self.flexible.links.first() else { return Ok(()) };
        let file = self.sources.last().map_or_else(String::new, |s| s.name.clone());
        Err(Error { file, ..refusal(&link.name, what, remedy) })
    }

    /// The robot whose links do not bend.
    pub fn with_rigid_links(&self) -> Self {
        Self { flexible: Flexible::default(), ..self.clone() }
    }
}

impl OwnedModel {
    /// Refuses a robot with links that bend, for `what` knows rigid ones only.
    pub(crate) fn refuse_bending(&self, what: &str) -> Result<(), Error> {
        match self.first_bending_link() {
            None => Ok(()),
            Some(link) => Err(refusal(link, what, RIGID)),
        }
    }
}

/// What helps where nothing better is known.
pub const RIGID: &str = "take the link out of `flexible_links` for this purpose: it is rigid then";

fn refusal(link: &str, what: &str, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Model,
        file: String::new(),
        element: format!("flexible_links.{link}"),
        problem: format!("the link bends, and {what} knows rigid links only"),
        remedy: remedy.to_owned(),
    }
}
