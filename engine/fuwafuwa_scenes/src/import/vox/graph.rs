//! The scene of a file: which models are visible, and their motions.
//!
//! ```text
//!   nTRN 0 ─ nGRP 1 ┬ nTRN 2 ─ nSHP 3      nTRN  a motion, a layer, a name, and one child
//!                   └ nTRN 4 ─ nGRP 5 ┬ …  nGRP  any number of children
//!                                     └ …  nSHP  a model, for each frame of an animation
//! ```

use super::chunk::{Attributes, Bytes, Chunk};
use super::motion::Motion;
use crate::import::error::{FilePosition, PositionedProblem, unexpected};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of nodes on all paths from the root. A node with several parents counts once for each
/// path.
pub(super) const MAX_VISITS: usize = 1 << 18;

/// Maximum number of names that an error lists.
const MAX_NAMES: usize = 20;

/// Nodes and layers of a file.
#[derive(Default)]
pub(super) struct Graph<'a> {
    nodes: BTreeMap<i32, Node<'a>>,
    hidden_layers: BTreeSet<i32>,
}

struct Node<'a> {
    place: FilePosition,
    is_hidden: bool,
    kind: Kind<'a>,
}

enum Kind<'a> {
    Transform {
        name: Option<&'a [u8]>,
        child: i32,
        layer: i32,
        motion: Motion,
        frames: usize,
    },
    Group(Vec<i32>),
    Shape(Vec<u32>),
}

/// A model and its motion. The model's pivot is at the origin before the motion.
#[derive(Clone, Copy)]
pub(super) struct Placement {
    pub model: usize,
    pub motion: Motion,
}

/// Visible models of a file, and what was left out.
#[derive(Default)]
pub(super) struct Placed {
    /// Models in the order of the scene.
    pub models: Vec<Placement>,
    /// Number of hidden models.
    pub hidden: usize,
    /// Number of models that the scene does not contain.
    pub unplaced: usize,
    /// Number of frames after the first.
    pub later_frames: usize,
    /// Number of nodes that were visited.
    pub visits: usize,
}

/// State of a node that it passes on to its children.
#[derive(Clone, Copy)]
struct State {
    motion: Motion,
    is_hidden: bool,
    /// Whether the node is below the part that was asked for.
    is_chosen: bool,
}

enum Step {
    Enter(i32, State),
    Leave(i32),
}

impl<'a> Graph<'a> {
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    pub fn add_layer(&mut self, chunk: &Chunk<'a>) -> Result<(), PositionedProblem> {
        let mut contents = chunk.contents;
        let id = contents.id("the id of a layer")?;
        if contents.attributes()?.is_hidden() {
            self.hidden_layers.insert(id);
        }
        Ok(())
    }

    /// Adds the node of a chunk nTRN, nGRP or nSHP.
    pub fn add_node(&mut self, chunk: &Chunk<'a>) -> Result<(), PositionedProblem> {
        let mut contents = chunk.contents;
        let id = contents.id("the id of a node")?;
        let attributes = contents.attributes()?;
        let kind = match &chunk.name {
            b"nTRN" => transform(chunk.place, &attributes, &mut contents)?,
            b"nGRP" => Kind::Group(contents.list("children", |bytes| bytes.id("a child"))?),
            _ => Kind::Shape(contents.list("models", |bytes| {
                let model = bytes.number("the number of a model")?;
                bytes.attributes().map(|_| model)
            })?),
        };
        let node = Node {
            place: chunk.place,
            is_hidden: attributes.is_hidden(),
            kind,
        };
        match self.nodes.insert(id, node) {
            None => Ok(()),
            Some(_) => {
                let found = format!("a second node {id}");
                Err(unexpected(
                    chunk.place,
                    "a node with an id of its own",
                    found,
                ))
            }
        }
    }

    /// Returns the models of the part called `part`, or of the whole scene. `is_solid` tells which models of
    /// the file have voxels.
    pub fn placed(
        &self,
        is_solid: &[bool],
        part: Option<&str>,
    ) -> Result<Placed, PositionedProblem> {
        if let Some(part) = part {
            self.check_name(part)?;
        }
        let mut walk = Walk {
            graph: self,
            is_solid,
            part: part.map(str::as_bytes),
            is_used: vec![false; is_solid.len()],
            above: BTreeSet::new(),
            to_do: Vec::new(),
            placed: Placed::default(),
        };
        for root in self.roots()?.into_iter().rev() {
            walk.push(root, State::of_root(part.is_none()))?;
        }
        while let Some(step) = walk.to_do.pop() {
            match step {
                Step::Enter(id, state) => walk.enter(id, state)?,
                Step::Leave(id) => _ = walk.above.remove(&id),
            }
        }
        let unused = walk.is_used.iter().zip(is_solid);
        let unused = unused.filter(|(is_used, is_solid)| **is_solid && !**is_used);
        walk.placed.unplaced = if part.is_none() { unused.count() } else { 0 };
        Ok(walk.placed)
    }

    /// Returns the root that MagicaVoxel writes, node 0, or all nodes without a parent.
    fn roots(&self) -> Result<Vec<i32>, PositionedProblem> {
        if self.nodes.contains_key(&0) {
            return Ok(vec![0]);
        }
        let children: BTreeSet<i32> = self.nodes.values().flat_map(Node::children).collect();
        let roots = self.nodes.keys().filter(|id| !children.contains(id));
        let roots: Vec<i32> = roots.copied().collect();
        match self.nodes.values().next() {
            Some(node) if roots.is_empty() => {
                let expected = "a node that is no child of another node";
                Err(unexpected(node.place, expected, "none"))
            }
            _ => Ok(roots),
        }
    }

    fn check_name(&self, part: &str) -> Result<(), PositionedProblem> {
        let names = self.nodes.values().filter_map(|node| match &node.kind {
            Kind::Transform { name, .. } => name.filter(|name| !name.is_empty()),
            _ => None,
        });
        let names: BTreeSet<&[u8]> = names.collect();
        if names.contains(part.as_bytes()) {
            return Ok(());
        }
        let listed = names
            .iter()
            .take(MAX_NAMES)
            .map(|name| quoted(&String::from_utf8_lossy(name)));
        let listed = listed.collect::<Vec<_>>().join(", ");
        let expected = match names.len() {
            0 => {
                "a named part (no part of the file has a name, so `model` cannot choose one)".into()
            }
            1..=MAX_NAMES => format!("the name of a part: {listed}"),
            count => format!("the name of a part: {listed} or {} more", count - MAX_NAMES),
        };
        Err(unexpected(FilePosition::File, expected, quoted(part)))
    }
}

impl Node<'_> {
    fn children(&self) -> Vec<i32> {
        match &self.kind {
            Kind::Transform { child, .. } => vec![*child],
            Kind::Group(children) => children.clone(),
            Kind::Shape(_) => Vec::new(),
        }
    }
}

impl State {
    fn of_root(is_chosen: bool) -> Self {
        Self {
            motion: Motion::NONE,
            is_hidden: false,
            is_chosen,
        }
    }
}

/// Walk through the nodes. It keeps its own stack, because the nodes of a file may be nested deeply.
struct Walk<'a> {
    graph: &'a Graph<'a>,
    is_solid: &'a [bool],
    part: Option<&'a [u8]>,
    is_used: Vec<bool>,
    /// Nodes from the root to the current one.
    above: BTreeSet<i32>,
    to_do: Vec<Step>,
    placed: Placed,
}

impl Walk<'_> {
    fn push(&mut self, id: i32, state: State) -> Result<(), PositionedProblem> {
        self.placed.visits += 1;
        if self.placed.visits > MAX_VISITS {
            // MagicaVoxel writes two nodes for each object and each group.
            let most = MAX_VISITS / 2;
            let expected = format!("at most {most} objects and groups, copies included");
            let advice = "more (merge objects before saving)";
            return Err(unexpected(FilePosition::File, expected, advice));
        }
        self.to_do.push(Step::Enter(id, state));
        Ok(())
    }

    fn enter(&mut self, id: i32, mut state: State) -> Result<(), PositionedProblem> {
        let graph = self.graph;
        let node = graph.nodes.get(&id).ok_or_else(|| {
            let expected = format!("a node {id}, which is a child of another node");
            unexpected(FilePosition::File, expected, "none")
        })?;
        if !self.above.insert(id) {
            let found = format!("node {id} below itself");
            return Err(unexpected(node.place, "nodes without a cycle", found));
        }
        self.to_do.push(Step::Leave(id));
        state.is_hidden |= node.is_hidden;
        match &node.kind {
            Kind::Transform {
                name,
                child,
                layer,
                motion,
                frames,
            } => {
                state.is_hidden |= graph.hidden_layers.contains(layer);
                if self.part.is_some() && self.part == *name {
                    // A part that was asked for by its name is taken even if it is hidden.
                    (state.is_hidden, state.is_chosen) = (false, true);
                }
                state.motion = state.motion.after(motion);
                self.note_frames(*frames, state);
                self.push(*child, state)
            }
            Kind::Group(children) => {
                let mut last_first = children.iter().rev();
                last_first.try_for_each(|&child| self.push(child, state))
            }
            Kind::Shape(models) => self.place(node.place, models, state),
        }
    }

    /// Places the first model of a shape that has voxels.
    fn place(
        &mut self,
        place: FilePosition,
        models: &[u32],
        state: State,
    ) -> Result<(), PositionedProblem> {
        let count = self.is_solid.len();
        let missing = models.iter().find(|&&model| model as usize >= count);
        if let Some(missing) = missing {
            let expected = format!("a model below {count}, the number of models in the file");
            return Err(unexpected(place, expected, missing));
        }
        let models = models.iter().map(|&model| model as usize);
        let models: Vec<usize> = models.filter(|&model| self.is_solid[model]).collect();
        for &model in &models {
            self.is_used[model] = true;
        }
        let Some(&model) = models.first().filter(|_| state.is_chosen) else {
            return Ok(());
        };
        if state.is_hidden {
            self.placed.hidden += 1;
            return Ok(());
        }
        self.note_frames(models.len(), state);
        let motion = state.motion;
        self.placed.models.push(Placement { model, motion });
        Ok(())
    }

    fn note_frames(&mut self, frames: usize, state: State) {
        if state.is_chosen && !state.is_hidden {
            self.placed.later_frames = self.placed.later_frames.max(frames - 1);
        }
    }
}

/// Reads the rest of a chunk nTRN. The first of several frames counts.
fn transform<'a>(
    place: FilePosition,
    attributes: &Attributes<'a>,
    contents: &mut Bytes<'a>,
) -> Result<Kind<'a>, PositionedProblem> {
    let child = contents.id("the child of a node")?;
    contents.id("the reserved number of a node")?;
    let layer = contents.id("the layer of a node")?;
    let frames = contents.list("frames", Bytes::attributes)?;
    let none = || unexpected(place, "at least one frame", "none");
    Ok(Kind::Transform {
        name: attributes.get("_name"),
        child,
        layer,
        motion: motion(place, frames.first().ok_or_else(none)?)?,
        frames: frames.len(),
    })
}

fn motion(place: FilePosition, frame: &Attributes) -> Result<Motion, PositionedProblem> {
    const IDENTITY: &[u8] = b"4";
    const NOWHERE: &[u8] = b"0 0 0";
    let rotation = frame.get("_r").unwrap_or(IDENTITY);
    let translation = frame.get("_t").unwrap_or(NOWHERE);
    let words = std::str::from_utf8(translation).ok();
    let numbers = words.map(|words| words.split_ascii_whitespace().map(str::parse));
    let numbers = numbers.and_then(|numbers| numbers.collect::<Result<Vec<i32>, _>>().ok());
    let Some(Ok(translation)) = numbers.map(<[i32; 3]>::try_from) else {
        let expected = "three whole numbers of voxels in _t";
        return Err(unexpected(
            place,
            expected,
            quoted(&String::from_utf8_lossy(translation)),
        ));
    };
    let byte = std::str::from_utf8(rotation).ok();
    let byte = byte.and_then(|byte| byte.trim().parse().ok());
    byte.and_then(|byte| Motion::of(byte, translation))
        .ok_or_else(|| {
            let expected = "a rotation by right angles in _r";
            unexpected(place, expected, quoted(&String::from_utf8_lossy(rotation)))
        })
}

/// Quotes the beginning of a text from a file.
fn quoted(text: &str) -> String {
    const MOST: usize = 40;
    let beginning: String = text.chars().take(MOST).collect();
    let rest = if beginning.len() < text.len() {
        "…"
    } else {
        ""
    };
    format!("\"{}{rest}\"", beginning.escape_debug())
}
