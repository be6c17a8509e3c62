//! Labels of widgets on the screen, for tests and for exhibits in a browser. They are read from the
//! accessibility tree, as a screen reader does.

use egui::{Context, FullOutput, Pos2, Rect};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Names and rectangles of all labelled widgets [points].
#[derive(Clone, Default)]
pub struct Labels(Arc<Mutex<Vec<(String, Rect)>>>);

impl Labels {
    /// Labels of the last frame.
    pub fn seen(&self) -> MutexGuard<'_, Vec<(String, Rect)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl egui::Plugin for Labels {
    fn debug_name(&self) -> &'static str {
        "labels"
    }

    fn output_hook(&mut self, _: &Context, output: &mut FullOutput) {
        let Some(tree) = output.platform_output.accesskit_update.take() else {
            return;
        };
        let nodes = tree.nodes.iter().filter_map(|(_, node)| {
            let bounds = node.bounds()?;
            let [low, high] = [(bounds.x0, bounds.y0), (bounds.x1, bounds.y1)]
                .map(|(x, y)| Pos2::new(x as f32, y as f32));
            Some((node.label()?.to_string(), Rect::from_min_max(low, high)))
        });
        *self.seen() = nodes.collect();
    }
}
