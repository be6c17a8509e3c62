//! Touch input: the first finger points, further fingers raise and turn, and any finger can press a button on
//! the screen.

use crate::game::ScreenButton;
use crate::input::Action;
use egui::{Event, Pos2, Rect, TouchDeviceId, TouchId, TouchPhase};
use std::collections::BTreeMap;

/// Distance that a finger must move before its movement is taken as either vertical or horizontal [points].
const DECIDED: f32 = 10.0;

/// Fingers on a touch screen. egui treats the first finger as a mouse. The movement of each further finger
/// counts either vertically or horizontally, depending on its first direction.
#[derive(Debug, Default)]
pub(super) struct Fingers {
    /// The pointing finger and its position.
    first: Option<(Finger, Pos2)>,
    others: BTreeMap<Finger, Drag>,
    /// The finger that egui treats as a mouse.
    mouse: Option<Finger>,
    /// Fingers that hold a button on the screen.
    holding: BTreeMap<Finger, Action>,
    drawn: DragDistance,
}

type Finger = (TouchDeviceId, TouchId);

#[derive(Debug)]
struct Drag {
    /// Current position.
    now: Pos2,
    /// Position up to which the movement was added to the drag distance.
    at: Pos2,
    way: Option<DragAxis>,
}

#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum DragAxis {
    Upright,
    Sideways,
}

/// Distance that all fingers except the pointing one moved [points].
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(super) struct DragDistance {
    /// Distance upwards.
    pub(super) up: f32,
    /// Distance to the right.
    pub(super) right: f32,
}

impl Fingers {
    /// Reads the touch events of a frame. Returns the entries of `buttons` on which a finger was put down.
    /// Leaves out the finger that egui treats as a mouse. A finger that is put down on one of `covers` does not point.
    pub(super) fn read_events(
        &mut self,
        events: &[Event],
        buttons: &[ScreenButton],
        covers: &[Rect],
    ) -> Vec<ScreenButton> {
        self.drawn = DragDistance::default();
        let mut pressed: Vec<ScreenButton> = Vec::new();
        for event in events {
            // Forgets all fingers when the window loses the focus, because the end of a touch is then not
            // reported.
            if let Event::WindowFocused(false) = event {
                *self = Self::default();
            }
            if let Event::Touch {
                device_id,
                id,
                phase,
                pos,
                ..
            } = *event
            {
                let finger = (device_id, id);
                let is_mouse = *self.mouse.get_or_insert(finger) == finger;
                if is_mouse && matches!(phase, TouchPhase::End | TouchPhase::Cancel) {
                    self.mouse = None;
                }
                let button = buttons.iter().find(|button| button.rect.contains(pos));
                match button.filter(|_| phase == TouchPhase::Start) {
                    Some(&button) => {
                        // Skips the finger that egui treats as a mouse: egui clicks the button itself when
                        // this finger is lifted.
                        if !is_mouse {
                            pressed.push(button);
                        }
                        self.holding.insert(finger, button.action);
                    }
                    None if phase == TouchPhase::Start
                        && covers.iter().any(|cover| cover.contains(pos)) => {}
                    None => self.touch(finger, phase, pos),
                }
            }
        }
        pressed
    }

    /// Returns the actions of the screen buttons that fingers hold.
    pub(super) fn pressed(&self) -> impl Iterator<Item = Action> {
        self.holding.values().copied()
    }

    /// Whether a finger is on the screen. Mouse events are ignored in this case: when the first finger lifts,
    /// a browser treats a remaining finger as the mouse.
    pub(super) fn are_down(&self) -> bool {
        self.first.is_some() || !self.others.is_empty() || !self.holding.is_empty()
    }

    /// Position of the pointing finger.
    pub(super) fn first(&self) -> Option<Pos2> {
        self.first.map(|(_, at)| at)
    }

    /// Position of a second finger, besides the pointing one.
    pub(super) fn second(&self) -> Option<Pos2> {
        self.others.values().next().map(|drag| drag.now)
    }

    /// Returns the distance that all fingers except the pointing one moved in this frame, and resets the
    /// distance to zero.
    pub(super) fn take(&mut self) -> DragDistance {
        std::mem::take(&mut self.drawn)
    }

    fn touch(&mut self, finger: Finger, phase: TouchPhase, at: Pos2) {
        match phase {
            TouchPhase::Start if self.first.is_none() || self.is_first(finger) => {
                self.first = Some((finger, at));
            }
            TouchPhase::Start => {
                let (now, way) = (at, None);
                self.others.insert(finger, Drag { now, at, way });
            }
            TouchPhase::Move if self.is_first(finger) => self.first = Some((finger, at)),
            TouchPhase::Move => self.draw(finger, at),
            TouchPhase::End | TouchPhase::Cancel => {
                self.others.remove(&finger);
                self.holding.remove(&finger);
                self.first = self.first.filter(|(first, _)| *first != finger);
            }
        }
    }

    fn is_first(&self, finger: Finger) -> bool {
        self.first.is_some_and(|(first, _)| first == finger)
    }

    fn draw(&mut self, finger: Finger, at: Pos2) {
        let Some(drag) = self.others.get_mut(&finger) else {
            return;
        };
        drag.now = at;
        let by = at - drag.at;
        if drag.way.is_none() && by.length() > DECIDED {
            drag.way = Some(match by.y.abs() > by.x.abs() {
                true => DragAxis::Upright,
                false => DragAxis::Sideways,
            });
        }
        match drag.way {
            Some(DragAxis::Upright) => self.drawn.up -= by.y,
            Some(DragAxis::Sideways) => self.drawn.right += by.x,
            None => return,
        }
        drag.at = at;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    /// Returns the movement [up, right] after touches in one frame, each given as (finger, phase, position).
    fn drawn(fingers: &mut Fingers, touches: &[(u64, TouchPhase, [f32; 2])]) -> [f32; 2] {
        let events = touches.iter().map(|&(id, phase, [x, y])| Event::Touch {
            device_id: TouchDeviceId(0),
            id: TouchId(id),
            phase,
            pos: pos2(x, y),
            force: None,
        });
        fingers.read_events(&events.collect::<Vec<_>>(), &[], &[]);
        let DragDistance { up, right } = fingers.take();
        [up, right]
    }

    #[test]
    fn second_finger_moves_along_one_axis_and_first_finger_along_none() {
        use TouchPhase::{Cancel, End, Move, Start};
        let mut fingers = Fingers::default();
        let first = [(1, Start, [100.0, 100.0]), (1, Move, [300.0, 300.0])];
        assert_eq!(drawn(&mut fingers, &first), [0.0; 2]);
        // The second finger moves nothing until its direction is clear, after 10 points. Then the whole
        // distance counts.
        assert_eq!(
            drawn(
                &mut fingers,
                &[(2, Start, [50.0, 50.0]), (2, Move, [53.0, 45.0])]
            ),
            [0.0; 2]
        );
        assert_eq!(drawn(&mut fingers, &[(2, Move, [55.0, 30.0])]), [20.0, 0.0]);
        assert_eq!(
            drawn(
                &mut fingers,
                &[(1, Move, [0.0, 0.0]), (2, Move, [95.0, 35.0])]
            ),
            [-5.0, 0.0]
        );
        assert_eq!(
            drawn(
                &mut fingers,
                &[(2, End, [95.0, 35.0]), (2, Move, [0.0, 0.0])]
            ),
            [0.0; 2]
        );
        let sideways = [
            (3, Start, [0.0, 0.0]),
            (3, Move, [30.0, 20.0]),
            (3, Move, [30.0, 90.0]),
        ];
        assert_eq!(drawn(&mut fingers, &sideways), [0.0, 30.0]);
        // After the first finger is lifted, the next new finger points.
        drawn(
            &mut fingers,
            &[(1, Cancel, [0.0; 2]), (3, Cancel, [0.0; 2])],
        );
        assert_eq!(
            drawn(
                &mut fingers,
                &[(4, Start, [0.0; 2]), (4, Move, [0.0, 90.0])]
            ),
            [0.0; 2]
        );
    }

    #[test]
    fn remaining_finger_does_not_point_but_next_new_finger_does() {
        use TouchPhase::{End, Move, Start};
        let mut fingers = Fingers::default();
        assert!(!fingers.are_down());
        drawn(
            &mut fingers,
            &[(1, Start, [9.0, 9.0]), (1, Move, [5.0, 6.0])],
        );
        drawn(&mut fingers, &[(2, Start, [70.0, 80.0])]);
        assert_eq!(fingers.first(), Some(pos2(5.0, 6.0)));
        drawn(
            &mut fingers,
            &[(1, End, [5.0, 6.0]), (2, Move, [71.0, 80.0])],
        );
        assert_eq!((fingers.are_down(), fingers.first()), (true, None));
        drawn(&mut fingers, &[(3, Start, [30.0, 30.0])]);
        assert_eq!(fingers.first(), Some(pos2(30.0, 30.0)));
        drawn(&mut fingers, &[(2, End, [0.0; 2]), (3, End, [0.0; 2])]);
        assert!(!fingers.are_down());
    }
}
