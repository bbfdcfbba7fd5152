//! A URDF as an XML tree with line numbers, read as forgivingly as other tools do and no more.

use crate::error::{Error, ErrorKind, Warning};
use roxmltree::{Document, Node};

/// Deeper files are no robots.
const MAX_DEPTH: u32 = 64;

/// A parsed URDF.
#[derive(Debug)]
pub(crate) struct Xml<'a> {
    document: Document<'a>,
    /// Name of the file, for messages.
    pub(crate) file: &'a str,
    skipped_lines: u32,
    /// Offsets of the line breaks: the parser itself would count them anew for every question.
    line_ends: Vec<usize>,
}

impl<'a> Xml<'a> {
    /// A document with its file's name, if it may be a robot. `skipped_lines` were taken off its start.
    pub(crate) fn new(document: Document<'a>, file: &'a str, skipped_lines: u32) -> Result<Self, Error> {
        let breaks = document.input_text().bytes().enumerate().filter(|(_, b)| *b == b'\n');
        let line_ends = breaks.map(|(i, _)| i).collect();
        let xml = Self { document, file, skipped_lines, line_ends };
        xml.check_depth()?;
        xml.check_root()?;
        Ok(xml)
    }

    /// The `<robot>` element.
    pub(crate) fn root(&self) -> Node<'_, 'a> {
        self.document.root_element()
    }

    /// The whole text.
    pub(crate) fn text(&self) -> &str {
        self.document.input_text()
    }

    /// File and line of a node.
    pub(crate) fn at(&self, node: Node<'_, '_>) -> String {
        let start = node.range().start;
        let row = self.line_ends.partition_point(|end| *end < start) + 1 + self.skipped_lines as usize;
        format!("{}:{row}", self.file)
    }

    /// The name of an element with its prefix as written, such as `drake:gear_ratio`.
    pub(crate) fn qualified<'n>(&'n self, node: Node<'n, '_>) -> &'n str {
        let tag = self.text()[node.range()].trim_start_matches('<');
        let end = tag.find(|c: char| c.is_whitespace() || c == '/' || c == '>').unwrap_or(tag.len());
        &tag[..end]
    }

    /// An error at a node.
    pub(crate) fn error(&self, node: Node<'_, '_>, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error {
            kind: ErrorKind::Urdf,
            file: self.at(node),
            element: describe(node),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// A warning at a node.
    pub(crate) fn warning(&self, node: Node<'_, '_>, message: impl Into<String>) -> Warning {
        Warning { file: self.at(node), element: describe(node), message: message.into() }
    }

    /// An attribute that must be there.
    pub(crate) fn attribute<'n>(&self, node: Node<'n, '_>, name: &str) -> Result<&'n str, Error> {
        node.attribute(name).ok_or_else(|| {
            let tag = node.tag_name().name();
            self.error(node, format!("<{tag}> has no attribute `{name}`"), format!("write <{tag} {name}=\"…\">"))
        })
    }

    /// An attribute of exactly `N` finite numbers, where it is there.
    pub(crate) fn numbers<const N: usize>(&self, node: Node<'_, '_>, name: &str) -> Result<Option<[f64; N]>, Error> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        let numbers = parse_numbers(text).ok_or_else(|| self.bad_number(node, name, text))?;
        let found = numbers.len();
        let all: [f64; N] = numbers.try_into().map_err(|_| {
            let problem = format!("`{name}=\"{text}\"` has {found} numbers, but needs {N}");
            self.error(node, problem, format!("give {N} numbers with blanks between them"))
        })?;
        if let Some(bad) = all.iter().find(|x| !x.is_finite()) {
            return Err(self.error(node, format!("`{name}` is {bad}"), "give finite numbers"));
        }
        Ok(Some(all))
    }

    /// The number in a text or attribute value.
    pub(crate) fn number(&self, node: Node<'_, '_>, name: &str, text: &str) -> Result<f64, Error> {
        match parse_numbers(text).as_deref() {
            Some([x]) if x.is_finite() => Ok(*x),
            _ => Err(self.bad_number(node, name, text)),
        }
    }

    /// A number that may be infinite, as limits may.
    pub(crate) fn limit(&self, node: Node<'_, '_>, name: &str) -> Result<Option<f64>, Error> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        match parse_numbers(text).as_deref() {
            Some([x]) if !x.is_nan() => Ok(Some(*x)),
            _ => Err(self.bad_number(node, name, text)),
        }
    }

    fn bad_number(&self, node: Node<'_, '_>, name: &str, text: &str) -> Error {
        let remedy = if text.contains("${") || text.contains("$(") {
            "this is xacro, not URDF: expand the file first (`xacro robot.urdf.xacro > robot.urdf`)"
        } else {
            "give a finite decimal number such as 0.5 or 1e-3"
        };
        self.error(node, format!("`{name}` is `{}`, which is not a finite number", text.trim()), remedy)
    }

    fn check_depth(&self) -> Result<(), Error> {
        let mut depth = vec![0_u32; self.document.descendants().count()];
        for node in self.document.descendants() {
            let Some(parent) = node.parent() else { continue };
            let here = depth[parent.id().get_usize()] + 1;
            depth[node.id().get_usize()] = here;
            if here > MAX_DEPTH {
                let problem = format!("elements are nested more than {MAX_DEPTH} deep");
                return Err(self.error(node, problem, "a URDF needs six levels; take the rest out"));
            }
        }
        Ok(())
    }

    fn check_root(&self) -> Result<(), Error> {
        let root = self.root();
        let remedy = match root.tag_name().name() {
            "robot" => "",
            "sdf" => "this is SDFormat: convert it to URDF",
            "mujoco" => "this is MJCF: convert it to URDF",
            _ => "give a URDF, whose outermost element is <robot>",
        };
        if !remedy.is_empty() {
            let problem = format!("the outermost element is <{}>, not <robot>", self.qualified(root));
            return Err(self.error(root, problem, remedy));
        }
        match root.children().find(|n| n.is_element() && self.qualified(*n).starts_with("xacro:")) {
            None => Ok(()),
            Some(node) => {
                let problem = format!("<{}> is xacro, not URDF", self.qualified(node));
                Err(self.error(node, problem, "expand the file first (`xacro robot.urdf.xacro > robot.urdf`)"))
            }
        }
    }
}

/// The elements below `node` with a plain name.
pub(crate) fn children<'n, 'i>(node: Node<'n, 'i>, name: &'static str) -> impl Iterator<Item = Node<'n, 'i>> {
    node.children().filter(move |n| n.has_tag_name(name))
}

/// The first element below `node` with a plain name: where other tools find two, they take this one.
pub(crate) fn child<'n, 'i>(node: Node<'n, 'i>, name: &'static str) -> Option<Node<'n, 'i>> {
    children(node, name).next()
}

/// The element a user looks for: the joint, link or transmission a node belongs to, else its tag.
fn describe(node: Node<'_, '_>) -> String {
    let named = node.ancestors().find(|n| {
        matches!(n.tag_name().name(), "joint" | "link" | "transmission")
            && n.parent().is_some_and(|p| p.has_tag_name("robot"))
    });
    match named {
        Some(n) => format!("{} `{}`", n.tag_name().name(), n.attribute("name").unwrap_or("")),
        None => format!("<{}>", node.tag_name().name()),
    }
}

fn parse_numbers(text: &str) -> Option<Vec<f64>> {
    text.split_whitespace().map(|word| word.parse().ok()).collect()
}
