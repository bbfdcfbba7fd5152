//! A load fixed to a link, as a file says it.

use super::inertial;
use super::nearest::nearest;
use super::yaml::Keys;
use crate::error::{Error, Warning};
use crate::robot::{Entry, Robot};
use gyroflex::spatial::{SpatialInertia, SymMat3, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A load rigidly fixed to a link, as if it were written into the URDF. Without `inertia` it is a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PayloadFile {
    /// Name of the link that carries it; links on fixed joints, such as a flange, too.
    pub link: String,
    /// Mass [kg]; 0 for no load.
    pub mass: f64,
    /// Centre of mass in the frame of `link` [m]; default: its origin.
    #[serde(default)]
    pub xyz: [f64; 3],
    /// Inertia [ixx, iyy, izz, ixy, ixz, iyz] about the centre of mass, in the axes of `link` [kg m²]; default: none.
    #[serde(default)]
    pub inertia: [f64; 6],
}

impl PayloadFile {
    /// Checks the numbers of the load that the key `path` describes.
    ///
    /// # Errors
    /// A mass or an inertia that no body has.
    pub(crate) fn check(&self, keys: &Keys, path: &str) -> Result<(), Error> {
        let fault =
            |key: &str, problem: String, remedy: &str| Err(keys.error(&format!("{path}.{key}"), problem, remedy));
        let all = [("mass", &[self.mass][..]), ("xyz", &self.xyz), ("inertia", &self.inertia)];
        if let Some((key, _)) = all.into_iter().find(|(_, numbers)| numbers.iter().any(|x| !x.is_finite())) {
            return fault(key, "it is not finite".to_owned(), "give finite numbers");
        }
        if self.mass < 0.0 {
            return fault("mass", format!("its mass is negative: {} kg", self.mass), "give its mass, or 0 for no load");
        }
        if self.mass == 0.0 && self.inertia.iter().any(|x| *x != 0.0) {
            return fault(
                "inertia",
                "it has an inertia, but no mass".to_owned(),
                "give its mass, or take the inertia out",
            );
        }
        match inertial::unphysical(&self.about_com()) {
            Some(problem) => fault(
                "inertia",
                problem,
                "give [ixx, iyy, izz, ixy, ixz, iyz] about the centre of mass; products of inertia are negative integrals",
            ),
            None => Ok(()),
        }
    }

    fn about_com(&self) -> SymMat3<f64> {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        SymMat3 { xx, yy, zz, xy, xz, yz }
    }

    /// Puts the load on a robot, in place of the one it may carry. `path` is the key that describes it.
    ///
    /// # Errors
    /// Numbers that no body has, or a link that the robot does not have.
    pub(crate) fn put_on(&self, robot: &mut Robot, keys: &Keys, path: &str) -> Result<(), Error> {
        self.check(keys, path)?;
        let Some(index) = robot.links.iter().position(|l| l.name == self.link) else {
            let near = nearest(&self.link, robot.links.iter().map(|l| l.name.as_str())).unwrap_or("none");
            let problem = format!("there is no link `{}`", self.link);
            let remedy = format!("name a link of the robot; the nearest one is `{near}`");
            return Err(keys.error(&format!("{path}.link"), problem, remedy));
        };
        let own = SpatialInertia::from_com(self.mass, Vec3::from(self.xyz), self.about_com());
        let link = &robot.links[index];
        let (body, inertia) = (link.body, own.seen_from_parent(link.placement));
        robot.set_payload(Some((index, inertia)));
        self.tell(robot, keys, path, body);
        Ok(())
    }

    /// Rows of the merged table, and a warning where the load rests on the world.
    fn tell(&self, robot: &mut Robot, keys: &Keys, path: &str, body: Option<usize>) {
        robot.table.retain(|row| !row.key.starts_with("payload."));
        let joint = body.map_or_else(String::new, |b| robot.joints[b].name.clone());
        let rows = [
            ("link", format!("`{}`", self.link), ""),
            ("mass", self.mass.to_string(), "kg"),
            ("xyz", format!("{:?}", self.xyz), "m"),
            ("inertia", format!("{:?}", self.inertia), "kg m²"),
        ];
        for (key, value, unit) in rows {
            let at = format!("{path}.{key}");
            let source = if keys.has(&at) { keys.locate(&at) } else { "default".to_owned() };
            robot.table.push(Entry { joint: joint.clone(), key: format!("payload.{key}"), value, unit, source });
        }
        if body.is_none() {
            let message = format!("it has no effect: link `{}` does not move", self.link);
            robot.warnings.push(Warning { file: keys.locate(path), element: path.to_owned(), message });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::PayloadFile;

    #[test]
    fn a_load_without_more_words_is_a_point_at_the_links_origin() {
        let load: PayloadFile = serde_json::from_str(r#"{"link": "l", "mass": 2}"#).expect("it is complete");
        assert_eq!((load.xyz, load.inertia), ([0.0; 3], [0.0; 6]));
    }
}
