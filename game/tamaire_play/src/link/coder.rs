//! Binary arithmetic coder without carries [Mahoney 2005]. A sequence of bits is coded as a number between 0
//! and 1. Each bit narrows the interval that contains the number. Well predicted bits narrow it little and
//! cost little space.

/// Probability that the next bit is a one, learned from the preceding bits.
#[derive(Copy, Clone, Debug)]
pub struct Chance {
    /// Probability of a one, in units of 1/65536. Neither 0 nor 1 is reached.
    one: u16,
    /// Number of bits from which the probability was learned, at most [`MEMORY`].
    seen: u8,
}

/// Approximate number of latest bits that determine a probability. With more, the model adapts too slowly.
const MEMORY: u8 = 120;

impl Default for Chance {
    fn default() -> Self {
        Self {
            one: 1 << 15,
            seen: 0,
        }
    }
}

impl Chance {
    /// Moves the probability towards `bit` by 1/(n + 1.5) of the difference, where n is the number of earlier
    /// bits. The probability stays close to the mean of the bits, but never reaches 0 or 1.
    fn learn(&mut self, bit: bool) {
        let wish = if bit { i32::from(u16::MAX) } else { 0 };
        let one = i32::from(self.one);
        let change = (wish - one) * 2 / (2 * i32::from(self.seen) + 3);
        self.one = (one + change) as u16;
        self.seen = (self.seen + 1).min(MEMORY);
    }
}

/// Encoder or decoder of bits. One trait, so that writing and reading use the same model code.
pub trait Bits {
    /// Codes the next bit. A writer encodes `bit` and returns it; a reader ignores `bit` and returns the
    /// decoded one.
    fn bit(&mut self, chance: &mut Chance, bit: bool) -> bool;
}

/// Interval that contains the coded number. Both ends are included and are given by their next 32 bits; the
/// bits before are already known. The first bytes of the ends differ.
#[derive(Copy, Clone, Debug)]
struct Range {
    low: u32,
    high: u32,
}

impl Range {
    const ALL: Self = Self {
        low: 0,
        high: u32::MAX,
    };

    /// Returns the end of the part of the interval that stands for a one: the last number in it.
    fn split(self, chance: &Chance) -> u32 {
        let width = u64::from(self.high - self.low);
        self.low + ((width * u64::from(chance.one)) >> 16) as u32
    }

    fn narrow(&mut self, split: u32, bit: bool) {
        match bit {
            true => self.high = split,
            false => self.low = split + 1,
        }
    }

    /// If both ends have the same first byte, removes this byte from the interval and returns it.
    fn next(&mut self) -> Option<u8> {
        let [low, high] = [self.low, self.high].map(|end| end >> 24);
        (low == high).then(|| {
            self.low <<= 8;
            self.high = self.high << 8 | 0xff;
            high as u8
        })
    }
}

/// Encoder of bits.
#[derive(Debug)]
pub struct Writer {
    range: Range,
    bytes: Vec<u8>,
}

impl Writer {
    pub fn new() -> Self {
        Self {
            range: Range::ALL,
            bytes: Vec::new(),
        }
    }

    /// Ends the encoding and returns the bytes. A reader treats missing bytes as zeros.
    pub fn finish(mut self) -> Vec<u8> {
        if self.range.low > 0 {
            // The first bytes of the ends differ, so the first byte of `low` plus one lies within the
            // interval.
            self.bytes.push((self.range.low >> 24) as u8 + 1);
        }
        self.bytes
    }
}

impl Bits for Writer {
    fn bit(&mut self, chance: &mut Chance, bit: bool) -> bool {
        self.range.narrow(self.range.split(chance), bit);
        chance.learn(bit);
        while let Some(byte) = self.range.next() {
            self.bytes.push(byte);
        }
        bit
    }
}

/// Decoder of bits. Any bytes can be decoded, and decoding never ends. The caller must know how many bits
/// were written.
#[derive(Debug)]
pub struct Reader<'a> {
    range: Range,
    value: u32,
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        let mut reader = Self {
            range: Range::ALL,
            value: 0,
            rest: bytes,
        };
        (0..4).for_each(|_| reader.take());
        reader
    }

    fn take(&mut self) {
        let next = self.rest.split_off_first().copied();
        self.value = self.value << 8 | u32::from(next.unwrap_or(0));
    }
}

impl Bits for Reader<'_> {
    fn bit(&mut self, chance: &mut Chance, _: bool) -> bool {
        let split = self.range.split(chance);
        let bit = self.value <= split;
        self.range.narrow(split, bit);
        chance.learn(bit);
        while self.range.next().is_some() {
            self.take();
        }
        bit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passed(bits: &[bool]) -> (Vec<bool>, usize) {
        let mut writer = Writer::new();
        let mut chance = Chance::default();
        bits.iter().for_each(|&bit| {
            writer.bit(&mut chance, bit);
        });
        let bytes = writer.finish();
        let (mut reader, mut chance) = (Reader::new(&bytes), Chance::default());
        let read = bits.iter().map(|_| reader.bit(&mut chance, false));
        (read.collect(), bytes.len())
    }

    #[test]
    fn bits_round_trip_close_to_their_entropy() {
        let mut random = fastrand::Rng::with_seed(1);
        // Tests random bits of which one in `one_in` is a one. `entropy` is the entropy of 10,000 such bits
        // [bytes], by H(p) = −p·log₂ p − (1−p)·log₂(1−p).
        for (one_in, entropy) in [(2, 1250.0), (10, 586.2), (1000, 14.3)] {
            let bits: Vec<bool> = (0..10_000).map(|_| random.u32(..one_in) == 0).collect();
            let (read, bytes) = passed(&bits);
            assert_eq!(read, bits);
            let most = 1.02 * entropy + 12.0;
            assert!((bytes as f64) < most, "1 in {one_in}: {bytes} of {most}");
        }
        for bits in [&[][..], &[true], &[false], &[true; 5000], &[false; 5000]] {
            let (read, bytes) = passed(bits);
            assert_eq!(read, bits);
            assert!(bytes < 10, "{bytes}");
        }
    }
}
