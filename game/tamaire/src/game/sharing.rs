//! Checking, keeping and sending of levels that the player makes.

use super::{Game, Maker, Screen};
use crate::platform::address_of_page;
use crate::qr::Code;
use crate::words::{MakingWords, Words};
use std::sync::Arc;
use tamaire_maker::check::Check;
use tamaire_maker::draft::{Draft, Language};
use tamaire_play::link::address;
use tamaire_play::{Level, Replay};

/// Maximum length of the name of a level or of its maker [characters].
pub const MOST_NAME: usize = 40;
/// Beginning of the ids of levels that the player makes. Levels from elsewhere get other ids.
const MADE_HERE: &str = "my-level-";
/// Share of a frame in which checks are computed, and the least and most time for that [s]. On a machine that draws slowly,
/// frames are long, and the checks get on nevertheless.
const BUDGET: (f64, [f64; 2]) = (0.6, [0.008, 0.15]);

/// Whether a level with this id was made by the player of this game.
pub(super) fn is_made_here(id: &str) -> bool {
    id.starts_with(MADE_HERE)
}

/// Returns the id of a level from elsewhere.
pub(super) fn foreign_id(id: &str) -> String {
    match id.strip_prefix(MADE_HERE) {
        Some(rest) => format!("sent-level-{rest}"),
        None => id.to_string(),
    }
}

impl Maker {
    /// Returns why the level is not finished, in words for its maker. `None` if it can be kept.
    pub fn problem(&self, said: &Words, words: &MakingWords) -> Option<String> {
        let wrong = self
            .draft
            .level()
            .err()
            .map(|error| (said.level_error)(&error));
        let has_name = !self.draft.name(Language::English).is_empty();
        wrong.or_else(|| (!has_name).then(|| words.needs_name.to_string()))
    }

    /// Returns the win of the level as it is now by its maker, even if the level has another name since.
    fn win_of(&self, level: &Level) -> Option<Replay> {
        self.won.as_ref()?.renamed(level)
    }

    /// Returns the shortest time in which its maker has won the level as it is now [s].
    pub fn won_by_maker(&self) -> Option<f32> {
        let won = self.win_of(&self.draft.level().ok()?)?;
        won.outcome.map(|outcome| outcome.seconds())
    }
}

impl Game {
    /// Returns the name of the level that is being edited, in the language of the player if it has one.
    pub fn draft_name(&self) -> &str {
        let names =
            [self.language_of_names(), Language::English].map(|it| self.maker.draft.name(it));
        names
            .into_iter()
            .find(|name| !name.is_empty())
            .unwrap_or_default()
    }

    /// Names the level that is being edited, in the language of the player. In the other language it gets the same name,
    /// unless the player has given it another one there.
    pub fn name_draft(&mut self, name: &str) {
        let language = self.language_of_names();
        let other = match language {
            Language::English => Language::Japanese,
            Language::Japanese => Language::English,
        };
        let draft = &mut self.maker.draft;
        let follows = draft.name(other).is_empty()
            || draft.name(other) == draft.name(language)
            || draft.name(other) == draft.first_name(other);
        draft.set_name(language, name);
        if follows {
            // Without a Japanese name, the English one is shown.
            draft.set_name(other, if other == Language::English { name } else { "" });
        }
    }

    fn language_of_names(&self) -> Language {
        match self.settings.language {
            crate::words::Language::English => Language::English,
            crate::words::Language::Japanese => Language::Japanese,
        }
    }

    /// Notes that the maker has won the level, if the round is a test of it.
    pub(super) fn note_test_win(&mut self) {
        if !self.is_test() {
            return;
        }
        let replay = self.bout.round().replay();
        let level = self.bout.round().level();
        let known = self.maker.win_of(level);
        if known.is_none_or(|known| replay.clock_ticks() < known.clock_ticks()) {
            self.maker.won = Some(replay);
        }
    }

    /// Begins to check the level that is being edited, or goes on with it in a frame of `seconds` [s].
    pub fn check_draft(&mut self, seconds: f32) {
        let Ok(level) = self.maker.draft.level() else {
            self.maker.check = None;
            return;
        };
        let is_known = { self.maker.check.as_ref() }
            .is_some_and(|check| check.level().differs_only_in_names(&level));
        if !is_known {
            self.maker.check = Some(Check::new(Arc::new(level)));
        }
        let clock = self.clock.clone();
        if let Some(check) = &mut self.maker.check {
            let (share, [least, most]) = BUDGET;
            let budget = (share * f64::from(seconds)).clamp(least, most);
            check.go_on(budget, || clock.now());
        }
    }

    /// Returns the level that is being edited with the names of its maker and of its origin, ready to be kept.
    fn finished(&mut self) -> Option<Level> {
        self.maker.draft.settle();
        if let Some(problem) = self.maker.problem(self.words(), self.making()) {
            self.notify(problem);
            return None;
        }
        let maker = cleaned(&self.settings.maker_name);
        self.maker
            .draft
            .set_maker((!maker.is_empty()).then_some(maker));
        if let Some(origin) = &self.maker.origin {
            self.maker.draft.set_origin(&cleaned(origin));
        }
        self.maker.draft.level().ok()
    }

    /// Keeps the level beside the shipped ones. Returns whether it can be kept.
    pub fn keep_draft(&mut self) -> bool {
        let Some(mut level) = self.finished() else {
            return false;
        };
        level.id = self.free_id(&level);
        self.maker.draft.set_id(&level.id);
        let text = self.maker.draft.text();
        let level = Arc::new(level);
        self.levels.retain(|known| known.id != level.id);
        self.levels.push(level.clone());
        self.files.keep_level_text(&level.id, text);
        self.maker.saved = Some(level.scene().clone());
        // From now on, this is the player's own level.
        self.maker.origin = None;
        if let Some(won) = self.maker.win_of(&level) {
            self.files.keep_best(&level, won);
        }
        self.notify(self.making().kept.to_string());
        true
    }

    /// Adds a copy of an own level.
    pub fn duplicate(&mut self, index: usize) {
        let mut level = Level::clone(&self.levels[index]);
        let text = self.text_of(&level);
        let mut draft = Draft::of_level(&level, text.as_deref());
        for language in [Language::English, Language::Japanese] {
            let name = draft.name(language).to_string();
            if !name.is_empty() {
                draft.set_name(language, &format!("{name} 2"));
            }
        }
        let Ok(copy) = draft.level() else {
            return;
        };
        level = copy;
        level.id = self.new_id();
        self.files.keep_level_text(&level.id, draft.text());
        self.levels.push(Arc::new(level));
    }

    /// Returns the id under which a level is kept: that of the own level that was changed, or a new one.
    fn free_id(&self, level: &Level) -> String {
        let is_own = self.maker.origin.is_none() && is_made_here(&level.id);
        match is_own {
            true => level.id.clone(),
            false => self.new_id(),
        }
    }

    /// Returns an id that no level has, not even one that was removed.
    fn new_id(&self) -> String {
        let numbered = (1..).map(|number| format!("{MADE_HERE}{number}"));
        let mut free = numbered.filter(|id| !self.is_taken(id));
        free.next().expect("there are more numbers than levels")
    }

    /// Copies a link to the level, with the maker's own round as a ghost to race if there is one.
    pub fn copy_link_to_draft(&mut self) {
        let Some(level) = self.finished() else {
            return;
        };
        // A round that is too long for a link is left out.
        let link = self.maker.win_of(&level).and_then(|won| won.link().ok());
        match link.map_or_else(|| level.link(), Ok) {
            Ok(link) => self.copied = Some(address(&address_of_page(), &link)),
            Err(error) => self.notify((self.words().link_error)(&error)),
        }
    }

    /// Returns the QR code of the link to the level. `None` if the level is too large for one.
    pub fn code_of_draft(&mut self) -> Option<Code> {
        let mut scene = self.maker.draft.scene().clone();
        if let Some(game) = &mut scene.game {
            let maker = cleaned(&self.settings.maker_name);
            game.made_by = (!maker.is_empty()).then_some(maker);
        }
        let level = Level::from_scene(self.maker.draft.id(), scene).ok()?;
        Code::of_level(&address_of_page(), &level)
    }

    /// Whether links lead to a page, so that a phone can open their QR codes.
    pub fn has_page(&self) -> bool {
        !address_of_page().is_empty()
    }

    /// Keeps the level, and gives it to the player as a file or tells where its file is.
    pub fn save_draft_file(&mut self) {
        if self.keep_draft() {
            let (id, text) = (self.maker.draft.id().to_string(), self.maker.draft.text());
            self.files.save_level(&id, text);
        }
    }

    /// Whether the level that was left in the editor has changes that were not kept.
    pub fn has_unsaved_level(&self) -> bool {
        let maker = &self.maker;
        maker.saved.as_ref() != Some(maker.draft.scene())
    }

    /// Leaves the editor. A new or own level is kept. A changed copy of another level, and one that cannot be played yet,
    /// stays in the making until another level is opened.
    pub fn leave_editor(&mut self) {
        self.end_drag();
        let is_own = self.maker.origin.is_none();
        if is_own && self.has_unsaved_level() && self.maker.draft.level().is_ok() {
            self.keep_draft();
        }
        self.screens.close(Screen::Editor);
        self.arrive();
    }
}

/// Returns who made a level and from which one it was made, as lines for the player.
pub fn credits(level: &Level, words: &MakingWords) -> Vec<String> {
    let game = level.game();
    let line = |name: &Option<String>, told: fn(&str) -> String| {
        let name = cleaned(name.as_deref()?);
        (!name.is_empty()).then(|| told(&name))
    };
    let lines = [
        line(&game.made_by, words.by),
        line(&game.changed_from, words.changed_from),
    ];
    lines.into_iter().flatten().collect()
}

/// Returns a name that other people chose as plain text: without control characters and without characters that change
/// the direction of writing, with single spaces, and at most [`MOST_NAME`] characters long.
pub fn cleaned(name: &str) -> String {
    let is_plain = |letter: &char| {
        let turns = matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        !letter.is_control() && !turns && *letter != '\u{feff}'
    };
    let plain: String = name
        .chars()
        .map(|letter| if letter == '\t' { ' ' } else { letter })
        .filter(is_plain)
        .collect();
    let words = plain.split_whitespace().collect::<Vec<_>>().join(" ");
    words
        .chars()
        .take(MOST_NAME)
        .collect::<String>()
        .trim()
        .to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_others_become_plain_text() {
        for (name, expected) in [
            ("Mika", "Mika"),
            ("  two\twords \n", "two words"),
            ("\u{202e}evil\u{200f}", "evil"),
            ("\u{7}", ""),
            ("みか", "みか"),
        ] {
            assert_eq!(cleaned(name), expected, "{name:?}");
        }
        assert_eq!(cleaned(&"x".repeat(100)).len(), MOST_NAME);
    }
}
