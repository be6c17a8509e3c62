//! Which screens lie over each other: the topmost is seen, and behind it is where the player came from.

/// What there is to see.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Screen {
    /// The name of the game, and a body that plays by itself. It lies below all others.
    Title,
    /// Which level?
    Levels,
    /// Rounds that were kept.
    Replays,
    /// The round.
    Play,
    /// The round, standing still.
    Paused,
    /// How it went.
    Result,
    /// A round that came by a link: to watch or to race?
    Offered,
    /// What players choose.
    Settings,
    /// What sticks and pads can do and what they are made to do.
    Forces,
    /// What is inside, and under which licences.
    Licences,
}

impl Screen {
    /// Whether it is opened from another, and goes back to it.
    fn opens_over(self, other: Self) -> bool {
        use Screen::*;
        match self {
            Title => false,
            Levels | Replays | Offered => other == Title,
            Play => matches!(other, Title | Levels | Replays | Offered),
            Paused | Result => other == Play,
            Settings => matches!(other, Title | Paused),
            Forces | Licences => other == Settings,
        }
    }
}

/// The screens that are open, the one that is seen last. There is always one.
#[derive(Clone, Debug)]
pub struct Screens(Vec<Screen>);

impl Default for Screens {
    fn default() -> Self {
        Self(vec![Screen::Title])
    }
}

impl Screens {
    /// The one that is seen.
    pub fn top(&self) -> Screen {
        *self.0.last().expect("one is always left")
    }

    /// Whether a screen is open, if below others.
    pub fn has(&self, screen: Screen) -> bool {
        self.0.contains(&screen)
    }

    /// Goes back to a screen that is open, or opens it over the topmost one from which it can be.
    pub(super) fn go(&mut self, screen: Screen) {
        let index = self.0.iter().rposition(|&open| open == screen);
        let index = index.or_else(|| self.0.iter().rposition(|&open| screen.opens_over(open)));
        self.0.truncate(index.unwrap_or(0) + 1);
        if self.top() != screen {
            self.0.push(screen);
        }
    }

    /// Closes a screen and whatever is open over it; the title stays.
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
    fn each_screen_goes_back_to_where_it_was_opened() {
        for (way, below) in [
            (&[Settings][..], Title),
            (&[Levels, Play, Paused, Settings], Paused),
            (&[Levels, Play, Paused, Settings, Forces], Settings),
            (&[Settings, Licences], Settings),
            (&[Levels, Play], Levels),
            (&[Replays, Play], Replays),
            (&[Play], Title),
            // What is dropped onto settings is played at once.
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
    fn a_round_is_left_with_all_that_is_open_over_it() {
        let mut screens = after(&[Levels, Play, Paused, Settings, Forces]);
        assert!(screens.has(Play));
        screens.close(Play);
        assert_eq!(screens.top(), Levels);
        screens.go(Title);
        screens.close(Title);
        assert_eq!(screens.top(), Title, "one is always left");
    }
}
