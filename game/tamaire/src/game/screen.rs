//! Stack of screens: the top one is visible, and below it is the screen from which it was opened.

/// A screen of the game.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Screen {
    /// Title of the game with a round that plays by itself. Always at the bottom of the stack.
    Title,
    /// Choice of levels.
    Levels,
    /// The ending, after the last level of the path.
    Ending,
    /// Explanation of how two players play.
    Together,
    /// Paper and block, on which players draw bodies.
    Paper,
    /// Editor of levels.
    Editor,
    /// Properties of a thing in the editor, or of its level.
    Properties,
    /// Page on which an edited level is checked, kept and sent.
    Finish,
    /// Saved rounds.
    Replays,
    /// The round.
    Play,
    /// The paused round.
    Paused,
    /// Tools of a playground, for players without a pointer.
    Toolbox,
    /// Result of the round.
    Result,
    /// A level or a round received by a link.
    Offered,
    /// Settings.
    Settings,
    /// Settings of sticks and pads, and their force feedback.
    Forces,
    /// Third-party parts and their licences.
    Licences,
}

impl Screen {
    /// Whether players draw bodies or make levels on this screen.
    pub fn is_of_making(self) -> bool {
        use Screen::*;
        matches!(self, Paper | Editor | Properties | Finish)
    }

    /// Whether this screen is opened from `other` and returns to it.
    fn opens_over(self, other: Self) -> bool {
        use Screen::*;
        match self {
            Title => false,
            Ending => matches!(other, Title | Levels),
            Levels | Together | Replays | Offered => other == Title,
            Paper => matches!(other, Title | Levels | Editor),
            Editor => matches!(other, Title | Levels | Offered),
            Properties | Finish => other == Editor,
            Play => matches!(other, Title | Levels | Paper | Editor | Replays | Offered),
            Paused | Result => other == Play,
            Toolbox => other == Paused,
            Settings => matches!(other, Title | Paused),
            Forces | Licences => other == Settings,
        }
    }
}

/// Open screens, the visible one last. Never empty.
#[derive(Clone, Debug)]
pub struct Screens(Vec<Screen>);

impl Default for Screens {
    fn default() -> Self {
        Self(vec![Screen::Title])
    }
}

impl Screens {
    /// Returns the visible screen.
    pub fn top(&self) -> Screen {
        *self.0.last().expect("the title screen is never closed")
    }

    /// Whether a screen is open, even below others.
    pub fn has(&self, screen: Screen) -> bool {
        self.0.contains(&screen)
    }

    /// Returns to an open screen, or opens it over the topmost screen from which it can be opened.
    pub(super) fn go(&mut self, screen: Screen) {
        let index = self.0.iter().rposition(|&open| open == screen);
        let index = index.or_else(|| self.0.iter().rposition(|&open| screen.opens_over(open)));
        self.0.truncate(index.unwrap_or(0) + 1);
        if self.top() != screen {
            self.0.push(screen);
        }
    }

    /// Closes a screen and all screens above it. The title stays open.
    pub(super) fn close(&mut self, screen: Screen) {
        let index = self.0.iter().position(|&open| open == screen);
        self.0.truncate(index.unwrap_or(self.0.len()).max(1));
    }
}

#[cfg(test)]
mod tests {
    use super::Screen::*;
    use super::*;

    fn after(way: &[Screen]) -> Screens {
        let mut screens = Screens::default();
        way.iter().for_each(|&screen| screens.go(screen));
        screens
    }

    #[test]
    fn closing_screen_returns_to_where_it_was_opened() {
        for (way, below) in [
            (&[Settings][..], Title),
            (&[Levels, Play, Paused, Settings], Paused),
            (&[Levels, Play, Paused, Settings, Forces], Settings),
            (&[Levels, Play, Paused, Toolbox], Paused),
            (&[Settings, Licences], Settings),
            (&[Levels, Play], Levels),
            (&[Levels, Play, Result, Ending], Levels),
            (&[Replays, Play], Replays),
            (&[Paper, Play], Paper),
            (&[Play], Title),
            // A file dropped onto the settings is played at once.
            (&[Levels, Play, Paused, Settings, Play], Levels),
            (&[Settings, Play], Title),
            (&[Replays, Play, Paused, Levels], Title),
        ] {
            let mut screens = after(way);
            let top = screens.top();
            assert_eq!(Some(&top), way.last());
            screens.close(top);
            assert_eq!(screens.top(), below, "{way:?}");
        }
    }

    #[test]
    fn closing_round_closes_screens_above_it() {
        let mut screens = after(&[Levels, Play, Paused, Settings, Forces]);
        assert!(screens.has(Play));
        screens.close(Play);
        assert_eq!(screens.top(), Levels);
        screens.go(Title);
        screens.close(Title);
        assert_eq!(screens.top(), Title, "the title screen is never closed");
    }
}
