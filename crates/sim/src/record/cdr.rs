//! Common Data Representation, as ROS 2 puts its messages on the wire: XCDR version 1, little endian.

/// Writes one message. Every number is aligned to its own size, counted from the end of the four-byte header.
pub(super) struct CdrWriter {
    bytes: Vec<u8>,
}

/// Encapsulation `CDR_LE` and no options.
const HEADER: [u8; 4] = [0, 1, 0, 0];

impl CdrWriter {
    pub(super) fn new() -> Self {
        Self { bytes: HEADER.to_vec() }
    }

    fn align(&mut self, size: usize) {
        let length = (self.bytes.len() - HEADER.len()).next_multiple_of(size) + HEADER.len();
        self.bytes.resize(length, 0);
    }

    pub(super) fn i32(&mut self, value: i32) {
        self.align(4);
        self.bytes.extend_from_slice(&value.to_le_bytes());
    }

    pub(super) fn u32(&mut self, value: u32) {
        self.align(4);
        self.bytes.extend_from_slice(&value.to_le_bytes());
    }

    /// Length of a sequence or string. Beyond 4 GiB nothing fits a message, nor the memory of its reader.
    fn length(&mut self, length: usize) {
        self.u32(u32::try_from(length).unwrap_or(u32::MAX));
    }

    /// A string: its length with the closing NUL, its bytes, the NUL.
    pub(super) fn string(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }

    pub(super) fn strings<'a>(&mut self, texts: impl ExactSizeIterator<Item = &'a str>) {
        self.length(texts.len());
        texts.for_each(|text| self.string(text));
    }

    /// A sequence of `float64`. An empty one is its length alone: nothing is aligned that is not there.
    pub(super) fn f64s(&mut self, values: impl ExactSizeIterator<Item = f64>) {
        self.length(values.len());
        for value in values {
            self.align(8);
            self.bytes.extend_from_slice(&value.to_le_bytes());
        }
    }

    pub(super) fn finish(self) -> Vec<u8> {
        self.bytes
    }
}
