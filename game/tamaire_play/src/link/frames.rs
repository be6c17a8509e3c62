//! Compression of input frames. The next target position of a hand is predicted: either the hand keeps its
//! velocity, or it rests. The prediction errors are coded with a model that learns their sizes while coding.

use super::coder::{Bits, Chance, Reader, Writer};
use crate::{InputFrame, PLAYERS};

/// Encodes frames: a byte that stores the [`Method`], followed by the coded frames. Tries both predictions
/// and takes the shorter result.
pub fn write(frames: &[InputFrame]) -> Vec<u8> {
    let unit = common_unit(frames);
    let ways = [false, true].map(|goes_on| Method { goes_on, unit });
    let told = ways.map(|way| {
        let mut writer = Writer::new();
        let mut model = Model::new(way);
        for &frame in frames {
            model.pass(&mut writer, frame);
        }
        [vec![way.byte()], writer.finish()].concat()
    });
    let shorter = told.into_iter().min_by_key(Vec::len);
    shorter.expect("there are two methods")
}

/// Decodes `count` frames. Returns `None` if the first byte is not a valid [`Method`].
pub fn read(bytes: &[u8], count: usize) -> Option<Vec<InputFrame>> {
    let (&first, told) = bytes.split_first()?;
    let mut model = Model::new(Method::of(first)?);
    let mut reader = Reader::new(told);
    let nothing = InputFrame::default();
    Some(
        (0..count)
            .map(|_| model.pass(&mut reader, nothing))
            .collect(),
    )
}

/// Parameters for coding frames, stored in the first byte.
#[derive(Copy, Clone, Debug)]
struct Method {
    /// `true`: a hand is predicted to keep its velocity. `false`: a hand is predicted to rest. Rest is the
    /// better prediction on a slow screen, where a mouse position arrives only every few ticks and hands move
    /// in jumps.
    goes_on: bool,
    /// Exponent of the largest power of two that divides all coordinates. They are divided by it before
    /// coding.
    unit: u32,
}

impl Method {
    fn byte(self) -> u8 {
        (self.unit as u8) << 1 | u8::from(self.goes_on)
    }

    fn of(byte: u8) -> Option<Self> {
        let (goes_on, unit) = (byte & 1 == 1, u32::from(byte >> 1));
        (unit < u16::BITS).then_some(Self { goes_on, unit })
    }
}

/// Returns the exponent of the largest power of two that divides all coordinates.
fn common_unit(frames: &[InputFrame]) -> u32 {
    let goals = frames.iter().flat_map(|frame| frame.goals).flatten();
    let units = goals.flatten().map(i16::trailing_zeros);
    units.min().unwrap_or(0).min(u16::BITS - 1)
}

/// Number of classes of prediction errors, see [`Track::class`].
const CLASSES: usize = 2 * 19;
/// Number of probabilities for the next binary digit of an error: one for each prefix of digits. All longer
/// prefixes share the last probability.
const GUESSED: usize = 64;

/// Adaptive model of the frames. Writer and reader learn the same probabilities from the same bits.
struct Model {
    way: Method,
    /// Probability that a player has a target, by player and by whether they had one in the last frame.
    present: [[Chance; 2]; PLAYERS],
    was_present: [bool; PLAYERS],
    /// Recent coordinates of each hand, on each axis.
    tracks: [[Track; 3]; PLAYERS],
    axes: [Differences; 3],
}

/// Recent coordinates of a hand on an axis.
#[derive(Copy, Clone, Default)]
struct Track {
    /// The last two coordinates, the latest first.
    past: Option<[i16; 2]>,
    /// The last three prediction errors, the latest first.
    off: [i16; 3],
}

/// Probabilities of the prediction errors on an axis. All arithmetic with errors wraps around at 16 bits.
struct Differences {
    /// Probability that an error has more than `index` binary digits, by class of the recent errors.
    longer: [[Chance; 16]; CLASSES],
    /// Probability that an error is negative, by the sign of the error before it.
    negative: [Chance; 3],
    /// Probability of an error's next binary digit, by the number of its digits and by the digits before.
    digits: [[Chance; GUESSED]; 17],
}

impl Model {
    fn new(way: Method) -> Self {
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

    /// Codes the next frame. A writer encodes `frame` and returns it; a reader ignores `frame` and returns
    /// the decoded frame.
    fn pass(&mut self, bits: &mut impl Bits, frame: InputFrame) -> InputFrame {
        let mut passed = InputFrame::default();
        for player in 0..PLAYERS {
            let goal = frame.goals[player];
            let was_present = &mut self.was_present[player];
            let chance = &mut self.present[player][usize::from(*was_present)];
            *was_present = bits.bit(chance, goal.is_some());
            if *was_present {
                let goal = goal.unwrap_or_default();
                let axes =
                    [0, 1, 2].map(|axis| self.code_coordinate(bits, player, axis, goal[axis]));
                passed.goals[player] = Some(axes);
            }
        }
        passed
    }

    fn code_coordinate(
        &mut self,
        bits: &mut impl Bits,
        player: usize,
        axis: usize,
        place: i16,
    ) -> i16 {
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

    /// Returns the class of the recent prediction errors. It depends on their size and on whether they grow.
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
        // Wraps around, because 2¹⁵ is its own negative in 16 bits.
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
    fn arbitrary_frames_round_trip() {
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
        assert_eq!(
            write(&coarse)[0] >> 1,
            12,
            "all coordinates are multiples of 4096"
        );
    }

    /// Guards existing links: if these bytes change, the links become unreadable, and `FORMAT` must change.
    #[test]
    fn encoding_of_frames_never_changes() {
        let goal = |tick: i16| [tick * tick - 900, 91 * (tick % 40), tick & 3];
        let frames: Vec<InputFrame> = (0..60)
            .map(|tick| frame([Some(goal(tick)), (tick > 9).then(|| goal(60 - tick))]))
            .collect();
        let bytes = write(&frames);
        assert_eq!(
            (bytes.len(), fuwafuwa::inspect::Hash::of(&bytes)),
            (44, 10_900_569_288_131_132_139)
        );
    }
}
