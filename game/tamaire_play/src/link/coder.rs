//! Bits in less room than they take: a binary arithmetic coder without carries [Mahoney 2005]. All bits together are one
//! number between 0 and 1; each narrows down where it lies, the less the better it was guessed.

/// How likely the next bit is a one, learned from those before it.
#[derive(Copy, Clone, Debug)]
pub struct Chance {
    /// In 1/65536, never none of them nor all.
    one: u16,
    /// How many bits it has learned from, up to [`MEMORY`].
    seen: u8,
}

/// About so many bits are remembered: with more, what changes is noticed late.
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
    /// Of n bits the next one changes it by 1/(n + 1.5) of what is missing: nearly their mean, and never certain.
    fn learn(&mut self, bit: bool) {
        let wish = if bit { i32::from(u16::MAX) } else { 0 };
        let one = i32::from(self.one);
        let change = (wish - one) * 2 / (2 * i32::from(self.seen) + 3);
        self.one = (one + change) as u16;
        self.seen = (self.seen + 1).min(MEMORY);
    }
}

/// A way for bits: what is written and what is read passes through the same model.
pub trait Bits {
    /// Lets the next bit pass. A writer takes the one that is given, a reader knows better.
    fn bit(&mut self, chance: &mut Chance, bit: bool) -> bool;
}

/// The numbers, as 32 bits after the point, between which the rest lies: both are among them, and their first bytes differ.
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

    /// The last number that stands for a one.
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

    /// The next byte, once it is certain.
    fn next(&mut self) -> Option<u8> {
        let [low, high] = [self.low, self.high].map(|end| end >> 24);
        (low == high).then(|| {
            self.low <<= 8;
            self.high = self.high << 8 | 0xff;
            high as u8
        })
    }
}

/// Makes bytes of bits.
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

    /// All that was written. Zeros follow, as far as anybody reads.
    pub fn finish(mut self) -> Vec<u8> {
        if self.range.low > 0 {
            // The first bytes of the ends differ: the least number with one byte more lies between them.
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

/// Makes bits of bytes. Any bytes are some bits, and there is no end to them: who reads knows when to stop.
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
    fn bits_come_back_in_little_more_room_than_their_chances_ask_for() {
        let mut random = fastrand::Rng::with_seed(1);
        // One in so many is a one. The entropy of 10,000 of them [bytes], by H(p) = −p·log₂ p − (1−p)·log₂(1−p).
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
