//! MATLAB's level 5 MAT-file, as much of it as arrays of numbers and lists of names need, uncompressed.
//!
//! A file is a header of 128 bytes and one element after the other; an element is its type, its length and its data, padded to
//! eight bytes (MathWorks, MAT-File Format, chapter 1).

/// A variable of the file.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Numbers of an array of these dimensions, the first index running fastest.
    Numbers(Vec<usize>, Vec<f64>),
    /// A matrix of characters with a line a row, filled up with spaces.
    Lines(Vec<String>),
}

const INT8: u32 = 1;
const UINT16: u32 = 4;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
/// Classes of arrays.
const CLASS_CHAR: u32 = 4;
const CLASS_DOUBLE: u32 = 6;

/// The bytes of a file with these variables. Names are letters, digits and underscores, a letter first.
pub fn file(variables: &[(&str, Value)]) -> Vec<u8> {
    let mut out = format!("{:<116}", "MATLAB 5.0 MAT-file, written by gyroflex").into_bytes();
    out.extend([0; 8]);
    out.extend(0x0100_u16.to_le_bytes());
    // Reads `MI` where the order of bytes is that of the writer.
    out.extend(*b"IM");
    for (name, value) in variables {
        element(&mut out, MATRIX, &array(name, value));
    }
    out
}

/// The parts of an array: class, dimensions, name, content.
fn array(name: &str, value: &Value) -> Vec<u8> {
    let (class, dimensions) = match value {
        Value::Numbers(dimensions, _) => (CLASS_DOUBLE, dimensions.clone()),
        Value::Lines(lines) => (CLASS_CHAR, vec![lines.len(), width(lines)]),
    };
    let mut out = Vec::new();
    element(&mut out, UINT32, &[class.to_le_bytes(), [0; 4]].concat());
    element(&mut out, INT32, &dimensions.iter().flat_map(|d| (*d as i32).to_le_bytes()).collect::<Vec<u8>>());
    element(&mut out, INT8, name.as_bytes());
    match value {
        Value::Numbers(_, numbers) => {
            element(&mut out, DOUBLE, &numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>());
        }
        Value::Lines(lines) => {
            let padded: Vec<Vec<u16>> = lines.iter().map(|l| l.encode_utf16().collect()).collect();
            let at = |row: &[u16], column: usize| row.get(column).copied().unwrap_or(u16::from(b' '));
            let columns = (0..width(lines)).flat_map(|c| padded.iter().map(move |row| at(row, c)));
            element(&mut out, UINT16, &columns.flat_map(u16::to_le_bytes).collect::<Vec<u8>>());
        }
    }
    out
}

fn width(lines: &[String]) -> usize {
    lines.iter().map(|l| l.encode_utf16().count()).max().unwrap_or(0)
}

fn element(out: &mut Vec<u8>, kind: u32, data: &[u8]) {
    out.extend(kind.to_le_bytes());
    out.extend((data.len() as u32).to_le_bytes());
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
}
