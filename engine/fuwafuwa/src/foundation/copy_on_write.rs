//! Values that copies share until one of them changes.

use super::hash::{Hash, HashState};
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// Value that rarely changes. A clone shares it, and [`CopyOnWrite::edit`] copies it first if it is shared. Copies of a world
/// therefore share all that has not changed between them.
pub struct CopyOnWrite<T>(Arc<T>);

impl<T: Clone> CopyOnWrite<T> {
    /// Returns the value for a change.
    pub fn edit(&mut self) -> &mut T {
        Arc::make_mut(&mut self.0)
    }
}

impl<T> CopyOnWrite<T> {
    /// Returns whether two owners share a value.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> From<T> for CopyOnWrite<T> {
    fn from(value: T) -> Self {
        Self(Arc::new(value))
    }
}

impl<T: Default> Default for CopyOnWrite<T> {
    fn default() -> Self {
        Self::from(T::default())
    }
}

impl<T> Clone for CopyOnWrite<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> Deref for CopyOnWrite<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: fmt::Debug> fmt::Debug for CopyOnWrite<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<T: HashState> HashState for CopyOnWrite<T> {
    fn hash_state(&self, hash: &mut Hash) {
        self.0.hash_state(hash);
    }
}

#[cfg(feature = "serde")]
impl<T: serde::Serialize> serde::Serialize for CopyOnWrite<T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de, T: serde::Deserialize<'de>> serde::Deserialize<'de> for CopyOnWrite<T> {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Blade, Dim2, Material, SoftBody, VoxelGrid};
    use glam::Vec2;

    #[test]
    fn clones_share_a_value_until_one_is_edited() {
        let mut first = CopyOnWrite::from(vec![1, 2]);
        let second = first.clone();
        assert!(first.is_same(&second));
        first.edit().push(3);
        assert!(!first.is_same(&second));
        assert_eq!(
            (first.as_slice(), second.as_slice()),
            (&[1, 2, 3][..], &[1, 2][..])
        );
        // An owner that shares with no one keeps its value.
        let before = first.as_ptr();
        first.edit()[0] = 0;
        assert_eq!(first.as_ptr(), before);
    }

    #[test]
    fn copies_of_a_body_share_their_topology_until_one_is_cut() {
        let grid = VoxelGrid::<Dim2>::ball(16, 1.0);
        let mut body = SoftBody::new(grid.unwrap(), &[Material::default()]).unwrap();
        let copy = body.clone();
        assert!(body.shares_topology_with(&copy));
        let blade = Blade::segment(Vec2::new(0.5, -1.0), Vec2::new(0.5, 2.0));
        assert!(!body.cut(&blade).detached.is_empty());
        assert!(!body.shares_topology_with(&copy));
        assert_eq!((body.piece_views().len(), copy.piece_views().len()), (2, 1));
    }
}
