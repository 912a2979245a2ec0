//! SHA-256, in the notations that people and browsers compare: hexadecimal and base64.

use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::io::{self, Read};

/// The SHA-256 of `bytes`, in hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// What is read from an input, summed up on the way: what is said of the bytes is said of those with
/// this sum.
#[derive(Debug)]
pub struct Summed<R> {
    input: R,
    sum: Sha256,
    bytes: u64,
}

impl<R: Read> Summed<R> {
    /// Nothing was read yet.
    pub fn new(input: R) -> Self {
        Summed { input, sum: Sha256::new(), bytes: 0 }
    }

    /// The sum of what was read, and how many bytes that are.
    pub fn so_far(&self) -> (Sha256, u64) {
        (self.sum.clone(), self.bytes)
    }

    /// Reads the rest; returns the SHA-256 of all, in hexadecimal, and how many bytes there are.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn finish(mut self) -> io::Result<(String, u64)> {
        io::copy(&mut self, &mut io::sink())?;
        Ok((hexadecimal(&self.sum.finalize()), self.bytes))
    }
}

impl<R: Read> Read for Summed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.input.read(buffer)?;
        self.sum.update(&buffer[..read]);
        self.bytes += read as u64;
        Ok(read)
    }
}

/// Bytes in lower-case hexadecimal.
pub fn hexadecimal(bytes: &[u8]) -> String {
    let mut out = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        let _ = write!(out, "{byte:02x}");
    }
    out
}

/// The bytes that [`hexadecimal`] writes so; `None` for other texts.
pub fn from_hexadecimal(text: &str) -> Option<Vec<u8>> {
    let digit = |byte: u8| match byte {
        b'0'..=b'9' => Some(byte - b'0'),
        b'a'..=b'f' => Some(byte - b'a' + 10),
        _ => None,
    };
    let byte = |pair: &[u8]| match pair {
        [high, low] => Some(digit(*high)? << 4 | digit(*low)?),
        _ => None,
    };
    text.as_bytes().chunks(2).map(byte).collect()
}

/// The source of a content security policy that admits an inline text by its SHA-256.
pub fn policy_source(text: &str) -> String {
    let mut digest = String::new();
    push_base64(&Sha256::digest(text.as_bytes()), &mut digest);
    format!("'sha256-{digest}'")
}

/// Appends the base64 of the bytes: RFC 4648, section 4, with padding.
pub fn push_base64(bytes: &[u8], text: &mut String) {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    text.reserve(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = (byte(0) << 16) | (byte(1) << 8) | byte(2);
        for i in 0..4 {
            // `group.len()` bytes are `group.len() + 1` digits, the rest is padding.
            let sextet = (bits >> (18 - 6 * i)) & 63;
            text.push(if i <= group.len() { char::from(ALPHABET[sextet as usize]) } else { '=' });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_read_is_summed_up_too() {
        let mut input = Summed::new(&b"abc"[..]);
        let mut first = [0];
        input.read_exact(&mut first).unwrap();
        assert_eq!((first, input.finish().unwrap()), (*b"a", (sha256(b"abc"), 3)));
    }

    #[test]
    fn digests_are_those_of_the_standards() {
        // FIPS 180-4, "abc"; RFC 4648, section 10.
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), abc);
        assert_eq!(from_hexadecimal(abc).map(|bytes| hexadecimal(&bytes)).as_deref(), Some(abc));
        for none in ["a", "0g", "0A", "é"] {
            assert_eq!(from_hexadecimal(none), None, "{none}");
        }
        for (text, encoded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            let mut found = String::new();
            push_base64(text.as_bytes(), &mut found);
            assert_eq!(found, encoded);
        }
        let mut found = String::new();
        push_base64(&[0xfb, 0xff, 0xbf], &mut found);
        assert_eq!(found, "+/+/");
    }
}
