//! What was played in few bytes. A hand goes on as it went, or rests: what it does is told as the difference to that, and how
//! large that is going to be is learned on the way.

use super::coder::{Bits, Chance, Reader, Writer};
use crate::{InputFrame, PLAYERS};

/// The frames in bytes: one that says in which way, and what is told so.
pub fn write(frames: &[InputFrame]) -> Vec<u8> {
    let unit = common_unit(frames);
    let ways = [false, true].map(|goes_on| Way { goes_on, unit });
    let told = ways.map(|way| {
        let mut writer = Writer::new();
        let mut model = Model::new(way);
        for &frame in frames {
            model.pass(&mut writer, frame);
        }
        [vec![way.byte()], writer.finish()].concat()
    });
    let shorter = told.into_iter().min_by_key(Vec::len);
    shorter.expect("there are two ways")
}

/// So many frames of the bytes, if those say in which way.
pub fn read(bytes: &[u8], count: usize) -> Option<Vec<InputFrame>> {
    let (&first, told) = bytes.split_first()?;
    let mut model = Model::new(Way::of(first)?);
    let mut reader = Reader::new(told);
    let nothing = InputFrame::default();
    Some(
        (0..count)
            .map(|_| model.pass(&mut reader, nothing))
            .collect(),
    )
}

/// In which way frames are told.
#[derive(Copy, Clone, Debug)]
struct Way {
    /// Whether a hand is expected to go on at its pace, or to rest where it is: a slow screen brings a mouse's place for several
    /// ticks at once, and then hands go by leaps.
    goes_on: bool,
    /// All numbers are multiples of 2 to this.
    unit: u32,
}

impl Way {
    fn byte(self) -> u8 {
        (self.unit as u8) << 1 | u8::from(self.goes_on)
    }

    fn of(byte: u8) -> Option<Self> {
        let (goes_on, unit) = (byte & 1 == 1, u32::from(byte >> 1));
        (unit < u16::BITS).then_some(Self { goes_on, unit })
    }
}

/// The largest power of two that divides all numbers, as its exponent.
fn common_unit(frames: &[InputFrame]) -> u32 {
    let goals = frames.iter().flat_map(|frame| frame.goals).flatten();
    let units = goals.flatten().map(i16::trailing_zeros);
    units.min().unwrap_or(0).min(u16::BITS - 1)
}

/// Classes of how surprising a hand was of late.
const CLASSES: usize = 2 * 19;
/// As many first digits of a number are guessed from those before them; further ones all alike.
const GUESSED: usize = 64;

/// What is expected next. Whoever writes and whoever reads learn the same.
struct Model {
    way: Way,
    /// Whether a player has a goal, by whether they had one.
    present: [[Chance; 2]; PLAYERS],
    was_present: [bool; PLAYERS],
    /// For each axis of each hand.
    tracks: [[Track; 3]; PLAYERS],
    axes: [Differences; 3],
}

/// What a hand did on an axis.
#[derive(Copy, Clone, Default)]
struct Track {
    /// The last two places, the latest first.
    past: Option<[i16; 2]>,
    /// By how much they were off what was expected, the latest first.
    off: [i16; 3],
}

/// What is known about differences on an axis. All arithmetic is that of 16 bits, around whose ends it goes.
struct Differences {
    /// Whether a number has more than so many binary digits, by class.
    longer: [[Chance; 16]; CLASSES],
    /// Whether it is below zero, by the sign of the last.
    negative: [Chance; 3],
    /// The next digit, by how many there are and by those before it.
    digits: [[Chance; GUESSED]; 17],
}

impl Model {
    fn new(way: Way) -> Self {
        let unknown = || Differences {
            longer: [[Chance::default(); 16]; CLASSES],
            negative: Default::default(),
            digits: [[Chance::default(); GUESSED]; 17],
        };
        Self {
            way,
            present: Default::default(),
            was_present: Default::default(),
            tracks: Default::default(),
            axes: [unknown(), unknown(), unknown()],
        }
    }

    /// Lets the next frame pass: a writer takes the one that is given, a reader knows better.
    fn pass(&mut self, bits: &mut impl Bits, frame: InputFrame) -> InputFrame {
        let mut passed = InputFrame::default();
        for player in 0..PLAYERS {
            let goal = frame.goals[player];
            let was_present = &mut self.was_present[player];
            let chance = &mut self.present[player][usize::from(*was_present)];
            *was_present = bits.bit(chance, goal.is_some());
            if *was_present {
                let goal = goal.unwrap_or_default();
                let axes = [0, 1, 2].map(|axis| self.place(bits, player, axis, goal[axis]));
                passed.goals[player] = Some(axes);
            }
        }
        passed
    }

    fn place(&mut self, bits: &mut impl Bits, player: usize, axis: usize, place: i16) -> i16 {
        let (track, axis) = (&mut self.tracks[player][axis], &mut self.axes[axis]);
        let place = place >> self.way.unit;
        let expected = track.expected(self.way.goes_on);
        let off = axis.difference(bits, track, place.wrapping_sub(expected));
        let place = expected.wrapping_add(off);
        track.note(place, off);
        place << self.way.unit
    }
}

impl Track {
    fn expected(&self, goes_on: bool) -> i16 {
        match self.past {
            Some([last, before]) if goes_on => last.wrapping_add(last.wrapping_sub(before)),
            Some([last, _]) => last,
            None => 0,
        }
    }

    fn note(&mut self, place: i16, off: i16) {
        let [last, _] = self.past.unwrap_or([place; 2]);
        self.past = Some([place, last]);
        self.off = [off, self.off[0], self.off[1]];
    }

    /// How surprising it was of late, and whether that grew.
    fn class(&self) -> usize {
        let [last, before, third] = self.off.map(|off| u32::from(off.unsigned_abs()));
        let size = u32::BITS - (2 * last + before + third).leading_zeros();
        2 * size as usize + usize::from(last > before)
    }
}

impl Differences {
    fn difference(&mut self, bits: &mut impl Bits, track: &Track, off: i16) -> i16 {
        let given = off.unsigned_abs();
        let given_length = (u16::BITS - given.leading_zeros()) as usize;
        let longer = &mut self.longer[track.class()];
        let mut length = 0;
        while length < 16 && bits.bit(&mut longer[length], length < given_length) {
            length += 1;
        }
        if length == 0 {
            return 0;
        }
        let sign = (track.off[0].signum() + 1) as usize;
        let is_negative = bits.bit(&mut self.negative[sign], off < 0);
        let digits = &mut self.digits[length];
        let mut size: u16 = 1;
        for digit in (0..length - 1).rev() {
            let chance = &mut digits[usize::from(size).min(GUESSED - 1)];
            let is_one = bits.bit(chance, given >> digit & 1 == 1);
            size = size << 1 | u16::from(is_one);
        }
        // 2¹⁵ is its own negative.
        if is_negative {
            size.wrapping_neg() as i16
        } else {
            size as i16
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(goals: [Option<[i16; 3]>; 2]) -> InputFrame {
        InputFrame { goals }
    }

    #[test]
    fn any_frames_come_back() {
        let ends = [i16::MIN, i16::MAX, 0, -1, 1];
        let wild = ends
            .iter()
            .flat_map(|&a| ends.map(|b| [a, b, a.wrapping_sub(b)]));
        let wild: Vec<InputFrame> = wild.map(|goal| frame([Some(goal), None])).collect();
        let coarse = [
            frame([None, Some([-4096, 8192, i16::MIN])]),
            frame([None; 2]),
        ];
        for frames in [&[][..], &wild, &coarse] {
            let bytes = write(frames);
            assert_eq!(read(&bytes, frames.len()).as_deref(), Some(frames));
        }
        assert_eq!(write(&coarse)[0] >> 1, 12, "all are multiples of 4096");
    }

    /// Else links that were sent can be read no more: then `FORMAT` has to change.
    #[test]
    fn the_same_frames_are_the_same_bytes_for_ever() {
        let goal = |tick: i16| [tick * tick - 900, 91 * (tick % 40), tick & 3];
        let frames: Vec<InputFrame> = (0..60)
            .map(|tick| frame([Some(goal(tick)), (tick > 9).then(|| goal(60 - tick))]))
            .collect();
        let bytes = write(&frames);
        assert_eq!(
            (bytes.len(), fuwafuwa::hash::Hash::of(&bytes)),
            (44, 10_900_569_288_131_132_139)
        );
    }
}
