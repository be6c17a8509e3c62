//! What holds for the whole world: gravity, air, substeps, and how long a tick is.

use crate::shape::Vector;

/// The usual length of a tick [s]; [`Settings::tick`] chooses another.
pub const TICK: f32 = 1.0 / 60.0;
/// Substeps in a tick of 1/60 s at the least, where the settings allow as many: a force-feedback stick wants its
/// force 960 times a second.
pub const USUAL_SUBSTEPS: u32 = 16;
/// The settings allow so many at the least: with them a soft ball is squashed as it is with 16.
pub const FEWEST_SUBSTEPS: u32 = 8;
/// The shortest and the longest tick [s]: in a shorter one than between two rounds of cracks there would be too many of
/// these; in a longer one hands, whose goals come once a tick, and captives and sleepers, which are looked for as often,
/// would be late by what one sees.
pub const SHORTEST_TICK: f32 = 1.0 / 240.0;
/// See [`SHORTEST_TICK`].
pub const LONGEST_TICK: f32 = 1.0 / 30.0;
/// Cracks are looked for, and swings are damped, so often in a second: in every fourth of the usual substeps, once in the time
/// that a node takes to give way. With half and twice as many bars bear the same load, to 0.2 %.
const ROUNDS: f64 = 240.0;
/// What of the settings is out of range: which field, and what was expected.
pub(super) type BadSetting = (&'static str, &'static str);

/// What holds for the whole world.
#[derive(Copy, Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Settings {
    /// [m/s²]; the third component does not count in 2D.
    pub gravity: Vector,
    /// Share of its speed that everything loses to the air in a second [1/s]; 0 to 10. With no
    /// gravity and about 1, bodies float.
    pub drag: f32,
    /// Substeps in 1/60 s at most, 8 to 1024, and as many in proportion in another tick; 64 if speed matters. A body too
    /// stiff for so many is softened until it is not, see [`Body::stiffness_scale`](crate::Body::stiffness_scale). Fewer than 16 make large soft bodies
    /// cheap.
    pub most_substeps: u32,
    /// Length of a tick [s], 1/240 to 1/30; 1/60 as a rule. With it a program is told how often it has a say: goals of hands,
    /// events, who touches whom. Substeps, cracks and damping come as often in a second whatever it is; shorter ticks
    /// cost a little more. Worlds of two tick lengths go alike, and not to the same bits.
    pub tick: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gravity: [0.0, -9.81, 0.0],
            drag: 0.0,
            most_substeps: 64,
            tick: TICK,
        }
    }
}

impl Settings {
    /// How many of what comes so often in a second come in a tick, and one at the least.
    pub(super) fn in_tick(&self, per_second: f64) -> u32 {
        ((f64::from(self.tick) * per_second + 0.5) as u32).max(1)
    }

    /// How often in a tick cracks are looked for.
    pub(super) fn rounds(&self) -> u32 {
        self.in_tick(ROUNDS)
    }

    /// From one time that they are looked for to the next [s].
    pub(super) fn round(&self) -> f32 {
        self.tick / self.rounds() as f32
    }

    /// Substeps in a tick at most.
    pub(super) fn most_in_tick(&self) -> u32 {
        self.in_tick(60.0 * f64::from(self.most_substeps))
    }

    /// The shortest substep that may be [s]: a body that needs a shorter one is softened.
    pub(super) fn shortest_substep(&self) -> f64 {
        f64::from(self.tick) / f64::from(self.most_in_tick())
    }

    pub(super) fn check(&self) -> Result<(), BadSetting> {
        let range = FEWEST_SUBSTEPS..=1024;
        let is_finite = self.gravity.iter().all(|k| k.is_finite());
        let checks = [
            ("gravity", "finite", is_finite),
            ("drag", "0 to 10", (0.0..=10.0).contains(&self.drag)),
            (
                "most_substeps",
                "8 to 1024",
                range.contains(&self.most_substeps),
            ),
            (
                "tick",
                "1/240 to 1/30 s",
                (SHORTEST_TICK..=LONGEST_TICK).contains(&self.tick),
            ),
        ];
        let bad = checks.into_iter().find(|(.., is_good)| !is_good);
        bad.map_or(Ok(()), |(field, expected, _)| Err((field, expected)))
    }
}
