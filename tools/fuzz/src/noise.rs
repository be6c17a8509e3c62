//! Reproducible damage to valid bytes.

use fastrand::Rng;
use std::collections::BTreeSet;

/// Replacements for numbers: limits of number types and other values that are often handled wrongly.
const NUMBERS: [&str; 14] = [
    "0",
    "-1",
    "1",
    "2",
    "255",
    "256",
    "65536",
    "4294967296",
    "9223372036854775807",
    "1e38",
    "-1e-40",
    "nan",
    "inf",
    "0.0",
];

/// Generator of damaged bytes.
pub struct Noise {
    rng: Rng,
    seeds: Vec<Vec<u8>>,
    words: Vec<Vec<u8>>,
}

impl Noise {
    /// Creates a generator from valid inputs `seeds`, and the seed `number` for the random changes.
    pub fn of(seeds: Vec<Vec<u8>>, number: u64) -> Self {
        let words = words(&seeds).into_iter().map(Vec::from).collect();
        let rng = Rng::with_seed(number);
        Self { rng, seeds, words }
    }

    /// Returns one of the valid inputs, chosen at random, with one to four changes.
    pub fn bytes(&mut self) -> Vec<u8> {
        let mut bytes = self.any_seed();
        for _ in 0..self.rng.usize(1..=4) {
            self.change(&mut bytes);
        }
        bytes
    }

    fn any_seed(&mut self) -> Vec<u8> {
        self.seeds[self.rng.usize(..self.seeds.len())].clone()
    }

    fn change(&mut self, bytes: &mut Vec<u8>) {
        let at = self.rng.usize(..=bytes.len());
        let end = (at + self.rng.usize(..32)).min(bytes.len());
        match self.rng.u8(..8) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let part = bytes[at..end].to_vec();
                let times = self.rng.usize(..64);
                bytes.splice(at..at, part.repeat(times));
            }
            3 => {
                let other = self.any_seed();
                let from = self.rng.usize(..=other.len());
                bytes.splice(at.., other[from..].iter().copied());
            }
            4 => {
                let word = self.rng.usize(..self.words.len());
                bytes.splice(at..end, self.words[word].iter().copied());
            }
            5 => self.replace_number(bytes, at),
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = match self.rng.u8(..3) {
                        0 => *byte ^ 1 << self.rng.u8(..8),
                        1 => [0, 1, 0x7f, 0x80, 0xff][self.rng.usize(..5)],
                        _ => self.rng.u8(..),
                    };
                }
            }
        }
    }

    /// Replaces the first number at or after the position `at`.
    fn replace_number(&mut self, bytes: &mut Vec<u8>, at: usize) {
        let is_part = |byte: &u8| byte.is_ascii_digit() || b".-".contains(byte);
        let Some(start) = bytes[at..].iter().position(u8::is_ascii_digit) else {
            return;
        };
        let start = at + start;
        let length = bytes[start..].iter().take_while(|byte| is_part(byte));
        let end = start + length.count();
        let number = NUMBERS[self.rng.usize(..NUMBERS.len())];
        bytes.splice(start..end, number.bytes());
    }
}

/// Returns the words that occur in the valid texts `seeds`, and some syntax of TOML.
pub fn words(seeds: &[Vec<u8>]) -> BTreeSet<&[u8]> {
    let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || b"_-".contains(byte);
    let words = seeds
        .iter()
        .flat_map(|seed| seed.split(move |byte| !is_part(byte)));
    let is_word = |word: &&[u8]| (2..24).contains(&word.len()) && word[0].is_ascii_alphabetic();
    let mut words: BTreeSet<&[u8]> = words.filter(is_word).collect();
    words.extend([&b"[["[..], b"]]", b" = ", b"\"", b"{ ", b" }", b"\n"]);
    words
}
