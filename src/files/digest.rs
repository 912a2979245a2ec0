//! SHA-256, in the notations that people and browsers compare: hexadecimal and base64.

use data_encoding::{BASE64, HEXLOWER};
use sha2::{Digest, Sha256};
use std::io::{self, Read};

/// The SHA-256 of `bytes`, in hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    HEXLOWER.encode(&Sha256::digest(bytes))
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
    HEXLOWER.encode(bytes)
}

/// The source of a content security policy that admits an inline text by its SHA-256.
pub fn policy_source(text: &str) -> String {
    format!("'sha256-{}'", BASE64.encode(&Sha256::digest(text.as_bytes())))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-4, "abc".
    #[test]
    fn what_is_not_read_is_summed_up_too() {
        let mut input = Summed::new(&b"abc"[..]);
        let mut first = [0];
        input.read_exact(&mut first).unwrap();
        assert_eq!((first, input.finish().unwrap()), (*b"a", (sha256(b"abc"), 3)));
    }

    /// FIPS 180-4, "abc".
    #[test]
    fn digests_are_those_of_the_standard() {
        let abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), abc);
        let abc = "'sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0='";
        assert_eq!(policy_source("abc"), abc);
    }
}
