//! The text of a URDF on its way to a strict XML parser.

use super::xml::Xml;
use crate::error::{Error, ErrorKind};
use roxmltree::{Document, ParsingOptions};

/// More elements, attributes and texts than any robot has.
const MAX_NODES: u32 = 2_000_000;
/// Name space given to prefixes that a file uses without declaring them.
const UNDECLARED: &str = "urn:undeclared";

/// The text of a URDF made fit for a strict XML parser.
#[derive(Debug)]
pub(crate) struct XmlText {
    file: String,
    text: String,
    /// Lines before the XML declaration, which the parser does not get to see.
    skipped_lines: u32,
}

impl XmlText {
    /// Takes leading blanks away and declares prefixes that are used undeclared, as files for Drake or Gazebo often do.
    pub(crate) fn new(text: &str, file: &str) -> Self {
        let start = text.trim_start_matches('\u{feff}').trim_start();
        let skipped = text.len() - start.len();
        let skipped_lines = text[..skipped].matches('\n').count() as u32;
        let mut this = Self { file: file.to_owned(), text: start.to_owned(), skipped_lines };
        for _ in 0..16 {
            match Document::parse_with_options(&this.text, parsing()) {
                Err(roxmltree::Error::UnknownNamespace(prefix, _)) if !prefix.is_empty() => {
                    let Some(end) = end_of_root_name(&this.text) else { break };
                    this.text.insert_str(end, &format!(" xmlns:{prefix}=\"{UNDECLARED}:{prefix}\""));
                }
                _ => break,
            }
        }
        this
    }

    /// Parses the text.
    pub(crate) fn parse(&self) -> Result<Xml<'_>, Error> {
        let document = Document::parse_with_options(&self.text, parsing()).map_err(|e| self.not_well_formed(&e))?;
        Xml::new(document, &self.file, self.skipped_lines)
    }

    fn not_well_formed(&self, e: &roxmltree::Error) -> Error {
        let line = e.pos().row + self.skipped_lines;
        let (problem, remedy) = match e {
            roxmltree::Error::DtdDetected => (
                "the file has a document type declaration, which may hide entities that swell without bound".to_owned(),
                "take `<!DOCTYPE …>` out and write its entities out",
            ),
            roxmltree::Error::NodesLimitReached => {
                ("the file has too many elements".to_owned(), "is this the file of one robot?")
            }
            other => (format!("the file is not well-formed XML: {other}"), "mend it; `xmllint` finds such places too"),
        };
        Error {
            kind: ErrorKind::Urdf,
            file: format!("{}:{line}", self.file),
            element: String::new(),
            problem,
            remedy: remedy.to_owned(),
        }
    }
}

/// Where the name of the outermost element ends, past comments and declarations.
fn end_of_root_name(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        at += text[at..].find('<')?;
        let rest = &text[at..];
        let close = if rest.starts_with("<!--") {
            "-->"
        } else if rest.starts_with("<?") {
            "?>"
        } else {
            return rest.find(|c: char| c.is_whitespace() || c == '/' || c == '>').map(|end| at + end);
        };
        at += rest.find(close)?;
    }
}

fn parsing<'input>() -> ParsingOptions<'input> {
    ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() }
}
