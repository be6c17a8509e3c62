//! Levels. A level is a text file with a scene and a table `[game]`.

mod frame;
mod path;
mod room;

pub use path::{CHAPTERS, Chapter, OPENING_SHARE, PATH, PathLevel};

use crate::round::start_targets;
use crate::rules::Basket;
use crate::{Assist, Route};
use frame::BodySize;
use fuwafuwa::inspect::Hash;
use fuwafuwa::{Dim, Dim2, Dim3, Vec3, VoxelGrid, World};
use fuwafuwa_scenes::import::FileType;
use fuwafuwa_scenes::scene::{
    BodyText, Fetch, GameText, LocalizedText, MAX_TEXT_BYTES, MotionTypeText, RigidBodyText, Scene,
    SceneError,
};
use std::any::Any;
use std::io;
use std::sync::{Arc, OnceLock};

/// Level that was checked, so its world can be built.
#[derive(Clone, Debug)]
pub struct Level {
    /// Name of a built-in level, or file name of any other level.
    pub id: String,
    scene: Scene,
    game: GameText,
    colours: Vec<Option<[u8; 3]>>,
    /// The [`Start`] in the level's dimension. The world is built at first use and then copied, because
    /// copying is far faster than building.
    start: Arc<OnceLock<Box<dyn Any + Send + Sync>>>,
    /// The [`Level::content_hash`], computed at first use.
    content_hash: Arc<OnceLock<u64>>,
}

/// World at the start, baskets, and the tints of each body.
type Start<D> = (World<D>, Vec<Basket<D>>, Vec<Option<VoxelGrid<D>>>);

impl PartialEq for Level {
    fn eq(&self, other: &Self) -> bool {
        (&self.id, &self.scene, &self.game) == (&other.id, &other.scene, &other.game)
    }
}

/// Reason why a level cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum LevelError {
    /// The scene is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture or a model cannot be made into a body.
    #[error("cannot make a body from {0}")]
    NoBody(
        /// Message: the file, the position in it, and the expected content.
        String,
    ),
    /// The scene is valid, but it cannot be played as a level.
    #[error("{id}: {field}: {reason}")]
    NoGame {
        /// Name of the level.
        id: String,
        /// Missing or invalid field.
        field: &'static str,
        /// Expected value.
        reason: String,
    },
    /// The file cannot be read, or is no text.
    #[error("{0}: {1}")]
    Unreadable(
        /// Name of the file.
        String,
        /// Reason why the file cannot be read.
        String,
    ),
    /// No built-in level has this name.
    #[error("no built-in level {id:?}, expected one of {known}")]
    Unknown {
        /// The name that was requested.
        id: String,
        /// Names of the built-in levels.
        known: String,
    },
    /// There is neither a built-in level of this name nor such a file.
    #[error("no level or file {id:?}, expected a file or one of {known}")]
    Missing {
        /// The name that was requested.
        id: String,
        /// Names of the built-in levels.
        known: String,
    },
}

/// Maximum number of solid voxels in all bodies of a level. For example, eight squares 64 voxels wide, or a cube
/// 32 voxels wide. Even if all these voxels are split apart, the world is built within seconds, runs slowly but
/// runs, and fits into one GPU buffer.
pub const MAX_VOXELS: usize = 1 << 15;
/// Maximum number of solid voxels in 3D if all bodies start whole and with large elements inside. For example, a
/// cube 64 voxels wide. This is eight times [`MAX_VOXELS`] but gives only five times as many elements.
pub const MAX_WHOLE_VOXELS: usize = 1 << 18;

/// Maximum size of a stored level with its embedded files [bytes].
pub const MAX_KEPT_BYTES: u64 = 1 << 23;

/// Built-in 2D levels in menu order: name and text.
pub const NAMED: [(&str, &str); 10] = [
    ("classic", include_str!("../levels/classic.toml")),
    ("gravity", include_str!("../levels/gravity.toml")),
    ("neck", include_str!("../levels/neck.toml")),
    ("twins", include_str!("../levels/twins.toml")),
    ("core", include_str!("../levels/core.toml")),
    ("donut", include_str!("../levels/donut.toml")),
    ("cat", include_str!("../levels/cat.toml")),
    ("rubber", include_str!("../levels/rubber.toml")),
    ("biscuit", include_str!("../levels/biscuit.toml")),
    ("sandbox", include_str!("../levels/sandbox.toml")),
];

/// Built-in 3D levels in menu order: name and text.
pub const NAMED_3D: [(&str, &str); 4] = [
    ("classic-3d", include_str!("../levels/classic-3d.toml")),
    ("hoop", include_str!("../levels/hoop.toml")),
    ("pudding", include_str!("../levels/pudding.toml")),
    ("sandbox-3d", include_str!("../levels/sandbox-3d.toml")),
];

/// Pictures and models of the built-in levels.
const FILES: [(&str, &[u8]); 2] = [
    ("cat.png", include_bytes!("../levels/cat.png")),
    ("pudding.vox", include_bytes!("../levels/pudding.vox")),
];

/// Returns name and text of every built-in level, in menu order: 2D levels, 3D levels, levels of the path.
pub fn built_in() -> impl Iterator<Item = (&'static str, &'static str)> {
    let path = PATH.iter().map(|level| (level.id, level.text));
    NAMED.into_iter().chain(NAMED_3D).chain(path)
}

impl Level {
    /// Opens a built-in level.
    ///
    /// # Errors
    /// [`LevelError::Unknown`] if there is no built-in level of this name.
    pub fn open(id: &str) -> Result<Self, LevelError> {
        let Some((_, text)) = built_in().find(|(known, _)| *known == id) else {
            let known: Vec<&str> = built_in().map(|(known, _)| known).collect();
            let (id, known) = (id.into(), known.join(", "));
            return Err(LevelError::Unknown { id, known });
        };
        let mut scene = Scene::read(id, text, &[])?;
        let fetch = |file: &str| {
            let known = FILES.iter().find(|(name, _)| *name == file);
            known.map_or_else(nothing, |(_, bytes)| Ok(bytes.to_vec()))
        };
        scene.embed_files(&fetch)?;
        // Skips the check that builds the world, because tests build the world of every built-in level.
        Self::unbuilt(id, scene)
    }

    /// Reads a level from the bytes of a file named `id`: a scene with a table `[game]`, or a picture or a
    /// MagicaVoxel model that becomes the body of a level. The content decides the type, not the name. `fetch`
    /// loads the files that a scene names.
    ///
    /// # Errors
    /// [`LevelError`] with the problem and its line.
    pub fn read(id: &str, bytes: &[u8], fetch: Fetch) -> Result<Self, LevelError> {
        let found = FileType::of(bytes);
        if let Some(frame) = frame::level_around(found) {
            return Self::framed(frame, id, bytes).map_err(|error| attribute_to_file(id, error));
        }
        if !found.is_plain_text() || found == FileType::Empty {
            let reason = format!("expected a level, a picture or a model, found {found}");
            return Err(LevelError::Unreadable(id.into(), reason));
        }
        let mut scene = without_assists(Scene::read(id, text_in(id, bytes, MAX_TEXT_BYTES)?, &[])?);
        scene.embed_files(fetch)?;
        forget_folders(&mut scene);
        Self::from_scene(id, scene)
    }

    /// Returns whether the content of a file is that of a level, or a picture or model that becomes one.
    pub fn is_in(bytes: &[u8]) -> bool {
        Self::is_text_in(bytes) || Self::is_body_in(bytes)
    }

    /// Returns whether the content of a file is a text with the table `[game]` of a level, perhaps with
    /// mistakes.
    pub fn is_text_in(bytes: &[u8]) -> bool {
        has_line(bytes, "[game]")
    }

    /// Returns whether the content of a file is a picture or a model, which becomes the body of a level.
    pub fn is_body_in(bytes: &[u8]) -> bool {
        frame::level_around(FileType::of(bytes)).is_some()
    }

    /// Reads a level that was stored with [`Level::text_to_keep`].
    ///
    /// # Errors
    /// As [`Level::read`].
    pub fn read_kept(id: &str, bytes: &[u8]) -> Result<Self, LevelError> {
        let text = text_in(id, bytes, MAX_KEPT_BYTES)?;
        Self::from_scene(id, without_assists(Scene::read(id, text, &[])?))
    }

    /// Returns the level as a text with all files embedded, for [`Level::read_kept`].
    ///
    /// # Errors
    /// [`LevelError::Unreadable`] if the text is too long.
    pub fn text_to_keep(&self) -> Result<String, LevelError> {
        let text = text_of(&self.scene);
        text_in(&self.id, text.as_bytes(), MAX_KEPT_BYTES)?;
        Ok(text)
    }

    /// Replaces the body of the built-in level `frame` with one made from a file.
    fn framed(frame: &str, id: &str, bytes: &[u8]) -> Result<Self, LevelError> {
        let mut level = Self::open(frame)?;
        level.id = id.into();
        let before = BodySize::of(&level.scene)?;
        let name = file_name(id);
        if let Some(body) = level.scene.body.first_mut() {
            (body.shape, body.file) = (None, Some(name.into()));
            if level.scene.dim == 2 {
                body.keep_colours = Some(true);
            } else {
                // Takes the resolution from the model, and gives all colours of the model the soft material.
                let all = (1..=u8::MAX).map(|index| (index.to_string(), 1));
                (body.n, body.colours) = (None, all.collect());
            }
        }
        level.game.name.en = stem(name).chars().take(60).collect();
        level.game.name.ja = None;
        level.scene.game = Some(level.game);
        level.scene.embed_files(&|_| Ok(bytes.to_vec()))?;
        frame::fit_body(&mut level.scene, &before)?;
        Self::from_scene(id, level.scene)
    }

    /// Checks a scene and makes it a level.
    ///
    /// # Errors
    /// [`LevelError`] with the problem.
    pub fn from_scene(id: &str, scene: Scene) -> Result<Self, LevelError> {
        let level = Self::unbuilt(id, scene)?;
        let checked = match level.scene.dim {
            2 => room::check(&level.start::<Dim2>()?.0, level.arena()),
            _ => room::check(&level.start::<Dim3>()?.0, level.arena()),
        };
        let checked = checked.and(room::check_hint(&level));
        let wrong = |(field, reason)| LevelError::NoGame {
            id: id.into(),
            field,
            reason,
        };
        checked.map(|()| level).map_err(wrong)
    }

    /// Makes a level without the checks that have to build its world.
    fn unbuilt(id: &str, scene: Scene) -> Result<Self, LevelError> {
        let missing = |field, reason: &str| LevelError::NoGame {
            id: id.into(),
            field,
            reason: reason.into(),
        };
        let game = scene.game.clone();
        let game = game.ok_or_else(|| missing("game", "expected a table [game] with a name"))?;
        let hands = start_targets(&scene).len();
        if !(1..=crate::PLAYERS).contains(&hands) {
            let reason = match scene.hand.iter().any(|hand| hand.follows.is_some()) {
                true => format!("expected 1 or 2 tables [[hand]] without follows, found {hands}"),
                false => format!("expected 1 or 2 tables [[hand]], found {hands}"),
            };
            return Err(missing("hand", &reason));
        }
        if scene.body.is_empty() {
            return Err(missing("body", "expected at least one table [[body]]"));
        }
        if scene.tick != fuwafuwa::DEFAULT_TICK {
            return Err(missing(
                "tick",
                "expected no tick: a tick of a level is 1/60 s",
            ));
        }
        let is_playable = |body: &RigidBodyText| {
            let known = [MotionTypeText::Fixed, MotionTypeText::Dynamic];
            known.contains(&body.motion_type) && body.state.is_none()
        };
        if !scene.rigid_body.iter().all(is_playable) {
            let reason = "expected motion_type = \"fixed\" or \"dynamic\"";
            return Err(missing("rigid_body", reason));
        }
        let [low, high] = scene.view;
        if low.iter().chain(&high).any(|k| k.abs() > 3.9) {
            let reason = "expected coordinates from -3.9 to 3.9 m: the view is the arena";
            return Err(missing("view", reason));
        }
        let (id, start) = (id.into(), Arc::default());
        let level = Self {
            id,
            colours: scene.colours(),
            scene,
            game,
            start,
            content_hash: Arc::default(),
        };
        let possible = level.possible_routes();
        let stated = &level.game.routes;
        if !stated.iter().all(|route| possible.contains(route)) {
            let reason = format!("expected some of {possible:?}, found {stated:?}");
            return Err(LevelError::NoGame {
                id: level.id,
                field: "game.routes",
                reason,
            });
        }
        Ok(level)
    }

    /// Returns the scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the table `[game]`.
    pub fn game(&self) -> &GameText {
        &self.game
    }

    /// Returns the colour of each material, number 1 first; `None` takes that of the palette. See
    /// [`Scene::colours`].
    pub fn colours(&self) -> &[Option<[u8; 3]>] {
        &self.colours
    }

    /// Returns the voxels of each body by the material numbers that decide their colours, for renderers; see
    /// [`Scene::tint_grids`]. Empty if the level has another dimension.
    pub fn tint_grids<D: Dim>(&self) -> &[Option<VoxelGrid<D>>] {
        let is_of_dim = usize::from(self.scene.dim) == D::N;
        let start = is_of_dim.then(|| self.start::<D>()).and_then(Result::ok);
        start.map_or(&[], |start| start.2.as_slice())
    }

    /// Returns whether two levels are equal except for their names, and those of their makers and origins.
    pub fn differs_only_in_names(&self, other: &Self) -> bool {
        self.scene == other.scene || without_names(&self.scene) == without_names(&other.scene)
    }

    /// Returns whether a body was drawn, or made from a picture that is not part of the game.
    pub fn is_drawing(&self, body: usize) -> bool {
        let is_drawn = |body: &BodyText| body.file.is_some() || body.voxels.is_some();
        let is_built_in = built_in().any(|(id, _)| id == self.id);
        self.scene.dim == 2 && !is_built_in && self.scene.body.get(body).is_some_and(is_drawn)
    }

    /// Returns the number of solid voxels of all bodies at the start.
    pub(crate) fn solid_voxels(&self) -> usize {
        match self.scene.dim {
            2 => self.start::<Dim2>().map_or(0, |start| solid_in(&start.0)),
            _ => self.start::<Dim3>().map_or(0, |start| solid_in(&start.0)),
        }
    }

    /// Returns for how many players the level has hands.
    pub fn players(&self) -> usize {
        start_targets(&self.scene).len()
    }

    /// Returns whether the level has a basket. Without one it is a playground.
    pub fn has_basket(&self) -> bool {
        self.game.basket.is_some() || !self.game.baskets.is_empty()
    }

    /// Returns the routes by which the level can be won. A level without a basket has none, and a level in
    /// which nothing tears has no shaving. If the level states routes, only these remain.
    pub fn routes(&self) -> &[Route] {
        match self.game.routes.as_slice() {
            [] => self.possible_routes(),
            stated => stated,
        }
    }

    /// Returns whether the level can be won only if something tears.
    pub fn must_tear(&self) -> bool {
        let is_shaved_only = !self.routes().is_empty() && !self.routes().contains(&Route::Squeeze);
        self.game.ignores(Assist::Unbreakable) || is_shaved_only
    }

    /// Returns the routes that the basket and the materials allow. `Mix` is not listed as a route of its own.
    fn possible_routes(&self) -> &'static [Route] {
        let materials = self.scene.materials();
        let can_tear = materials.iter().any(|m| m.strength.is_finite());
        match (self.has_basket(), can_tear) {
            (false, _) => &[],
            (true, false) => &[Route::Squeeze],
            (true, true) => &[Route::Squeeze, Route::Shave],
        }
    }

    /// Returns the low and the high corner of the room in which hands can move [m].
    pub fn arena(&self) -> [Vec3; 2] {
        self.scene.view.map(Vec3::from)
    }

    /// Returns a hash of the level, assists included. Equal hashes mean equal levels.
    pub fn hash(&self) -> u64 {
        hash_of(&self.scene)
    }

    /// Returns a hash of the level without assists and names. Levels with equal hashes differ only in names and assists.
    pub fn content_hash(&self) -> u64 {
        *self
            .content_hash
            .get_or_init(|| hash_of(&without_assists(without_names(&self.scene))))
    }

    /// Returns a copy of the world at the start, and the baskets.
    pub(crate) fn build<D: Dim>(&self) -> (World<D>, Vec<Basket<D>>) {
        let start = self.start::<D>();
        let (world, baskets, _) =
            start.expect("tests build built-in levels, from_scene other levels");
        (world.clone(), baskets.clone())
    }

    /// Returns the world at the start, the baskets, and the tints. The world is built at the first call.
    fn start<D: Dim>(&self) -> Result<&Start<D>, SceneError> {
        let known = match self.start.get() {
            Some(known) => known,
            None => {
                let start: Start<D> = (
                    self.scene.build_within(most_solid::<D>(&self.scene))?,
                    Basket::all(&self.game, self.scene.baskets::<D>()?),
                    self.scene.tint_grids::<D>()?,
                );
                self.start.get_or_init(|| Box::new(start))
            }
        };
        Ok(known.downcast_ref().expect("a level has one dimension"))
    }
}

/// Returns the hash of a scene; see [`Level::hash`].
pub(crate) fn hash_of(scene: &Scene) -> u64 {
    // Hashes the key `max_substeps` under its former name. So the hashes in existing replays, links and
    // logbooks stay valid.
    let text = text_of(scene).replacen("\nmax_substeps = ", "\nmost_substeps = ", 1);
    Hash::of(text.as_bytes())
}

pub(crate) fn text_of(scene: &Scene) -> String {
    toml::to_string(scene).expect("a scene that was read can be serialized")
}

/// Removes the assists that an untrusted scene claims to have. Only the level of a recorded round may state
/// assists.
pub(crate) fn without_assists(mut scene: Scene) -> Scene {
    if let Some(game) = &mut scene.game {
        game.assists.clear();
    }
    scene
}

/// Returns a scene without the names of the level, of its maker and of its origin, which do not affect a round.
pub(crate) fn without_names(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    if let Some(game) = &mut scene.game {
        game.name = LocalizedText::default();
        (game.made_by, game.changed_from) = (None, None);
    }
    scene
}

/// Removes the folders from the file names in a scene, so that a replay does not reveal them.
fn forget_folders(scene: &mut Scene) {
    for file in scene.body.iter_mut().filter_map(|body| body.file.as_mut()) {
        *file = file_name(file).into();
    }
}

/// Returns the name of a file without its folders.
fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Returns the name of a level without folders and extension.
pub(crate) fn stem(id: &str) -> &str {
    let name = file_name(id);
    let stem = name.rsplit_once('.').map(|(stem, _)| stem);
    stem.filter(|stem| !stem.is_empty()).unwrap_or(name)
}

fn nothing() -> io::Result<Vec<u8>> {
    Err(io::ErrorKind::NotFound.into())
}

/// Returns whether the bytes are a text with a line that begins with `beginning`. Spaces in the line are ignored:
/// `[ game ]` is the same in TOML as `[game]`.
pub(crate) fn has_line(bytes: &[u8], beginning: &str) -> bool {
    let text = std::str::from_utf8(bytes).unwrap_or_default();
    let length = beginning.chars().count();
    text.lines().any(|line| {
        let letters = line.chars().filter(|letter| !letter.is_whitespace());
        letters.take(length).eq(beginning.chars())
    })
}

/// Returns the bytes of a file as a text. Fails if the file has more than `most` bytes or is no text.
fn text_in<'a>(id: &str, bytes: &'a [u8], most: u64) -> Result<&'a str, LevelError> {
    let wrong = |reason: String| LevelError::Unreadable(id.into(), reason);
    let found = bytes.len() as u64;
    if found > most {
        return Err(wrong(format!(
            "expected at most {most} bytes, found {found}"
        )));
    }
    let text = std::str::from_utf8(bytes);
    text.map_err(|_| {
        let found = FileType::of(bytes);
        wrong(format!("expected a text in UTF-8, found {found}"))
    })
}

/// Makes an error in a body name the file from which the body was made. The player chose the file, not the
/// level around it.
fn attribute_to_file(file: &str, error: LevelError) -> LevelError {
    match error {
        LevelError::Scene(SceneError::Shape { mut error, .. }) => {
            error.file = file.into();
            LevelError::NoBody(error.to_string())
        }
        LevelError::Scene(SceneError::Build { reason, .. }) => {
            LevelError::NoBody(format!("{file}: {reason}"))
        }
        error => error,
    }
}

fn solid_in<D: Dim>(world: &World<D>) -> usize {
    { world.soft_bodies() }
        .map(|(_, body)| body.grid().solid_count())
        .sum()
}

fn most_solid<D: Dim>(scene: &Scene) -> usize {
    let is_fine = |body: &BodyText| body.crumbled || body.diced.is_some() || body.uniform;
    match D::N == 3 && !scene.body.iter().any(is_fine) {
        true => MAX_WHOLE_VOXELS,
        false => MAX_VOXELS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_level_opens() {
        for (id, _) in built_in() {
            let level = Level::open(id);
            let scene = level.map(|level| level.scene);
            let checked = scene.and_then(|scene| Level::from_scene(id, scene));
            assert!(checked.is_ok(), "{id}: {checked:?}");
        }
    }

    #[test]
    fn has_line_ignores_spaces() {
        for text in ["dim = 2\n[game]\n", "  [game]", "\t[ game ]\r\n"] {
            assert!(has_line(text.as_bytes(), "[game]"), "{text:?}");
        }
        for text in ["", "[gam", "# [game]", "name = \"[game]\"", "[games]"] {
            assert!(!has_line(text.as_bytes(), "[game]"), "{text:?}");
        }
        assert!(has_line(b"version = 7\n  level_hash = \"0\"", "level_hash"));
    }

    #[test]
    fn routes_follow_from_the_material() {
        let routes = |id| Level::open(id).unwrap().routes().to_vec();
        let both = [Route::Squeeze, Route::Shave];
        for (id, expected) in [
            ("classic", &both[..]),
            ("rubber", &both[..1]),
            ("biscuit", &both[1..]),
            ("sandbox", &[]),
        ] {
            assert_eq!(routes(id), expected, "{id}");
        }
        for (id, _) in built_in() {
            let level = Level::open(id).unwrap();
            let mut wished = level.game().wish.iter().filter_map(|wish| wish.route);
            assert!(wished.all(|route| level.routes().contains(&route)), "{id}");
        }
    }

    #[test]
    fn level_with_an_impossible_route_is_rejected() {
        let (_, rubber) = NAMED[7];
        let refused = refusal("rubber", rubber, &["game.routes=[\"shave\"]"]);
        let expected = "rubber: game.routes: expected some of [Squeeze], found [Shave]";
        assert_eq!(refused.as_deref(), Some(expected));
    }

    #[test]
    fn level_with_an_unreachable_body_is_rejected() {
        let (_, twins) = NAMED[3];
        let refused = refusal("twins", twins, &["body.2.at=[2.0, 0.0, 0.0]"]);
        let expected =
            "twins: body: expected all bodies in the view; the centre of body 2 is outside";
        assert_eq!(refused.as_deref(), Some(expected));
    }

    #[test]
    fn level_with_a_hint_outside_the_view_is_rejected() {
        let (_, twins) = NAMED[3];
        let hint = "game.hint=[[0.0, 0.0, 0.0, 0.0], [1.0, 5.0, 0.0, 0.0]]";
        let refused = refusal("twins", twins, &[hint]);
        let expected = "twins: game.hint: expected positions in the view; point 2 is outside";
        assert_eq!(refused.as_deref(), Some(expected));
    }

    #[test]
    fn hash_of_an_unchanged_level_stays_the_same() {
        // Hashes in recordings and logbooks. Pudding has another toughness than in version 0.2.0.
        for (id, hash) in [
            ("classic", 0x1dac_fb28_8e52_f666),
            ("pudding", 0x0f99_9c74_e23b_5725),
        ] {
            assert_eq!(Level::open(id).unwrap().hash(), hash, "{id}");
        }
    }

    #[test]
    fn worlds_built_from_one_level_are_independent_and_equal() {
        let level = Level::open("twins").unwrap();
        let built = level.scene.build::<Dim2>().unwrap();
        let mut rounds = [0, 1].map(|_| level.build::<Dim2>().0);
        rounds[0].step();
        assert_ne!(rounds[0].hash(), built.hash());
        let again = level.clone().build::<Dim2>().0;
        assert_eq!(
            (rounds[1].hash(), again.hash()),
            (built.hash(), built.hash())
        );
    }

    /// Returns the error message of a level whose text was changed, or `None` if it is valid.
    fn refusal(id: &str, text: &str, changes: &[&str]) -> Option<String> {
        let changes: Vec<String> = changes.iter().map(|change| change.to_string()).collect();
        let scene = Scene::read(id, text, &changes).unwrap();
        Level::from_scene(id, scene)
            .err()
            .map(|error| error.to_string())
    }

    #[test]
    fn level_with_too_many_voxels_is_rejected() {
        let [(id, flat), (id_3d, solid)] = [NAMED[0], NAMED_3D[0]];
        // The bodies are balls, of π/4 n² or π/6 n³ solid voxels.
        let few = "body 1, n: expected 32768 solid voxels at most";
        let many = "body 1, n: expected 262144 solid voxels at most";
        for (id, text, changes, expected) in [
            (id, flat, &["body.n=203"][..], None),
            (id, flat, &["body.n=206"], Some(few)),
            (id_3d, solid, &["body.n=79"], None),
            (id_3d, solid, &["body.n=81"], Some(many)),
            (
                id_3d,
                solid,
                &["body.n=41", "body.crumbled=true"],
                Some(few),
            ),
            (id_3d, solid, &["body.n=41", "body.diced=0.1"], Some(few)),
            (id_3d, solid, &["body.n=41", "body.uniform=true"], Some(few)),
        ] {
            let found = refusal(id, text, changes);
            let is_as_expected = match expected {
                Some(expected) => found.as_ref().is_some_and(|text| text.contains(expected)),
                None => found.is_none(),
            };
            assert!(is_as_expected, "{id}, {changes:?}: {found:?}");
        }
    }
}
