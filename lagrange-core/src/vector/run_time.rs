//! Run-time lengths, whose vectors are on the heap.

use alloc::{boxed::Box, vec, vec::Vec};
use core::ops::{Index, IndexMut};

use nalgebra::{Const, DVector, Dyn};

use super::{Element, Kind, Length, Numbers, StaticLength};

/// Kind of the run-time lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunTime;

impl Length for Dyn {
    type Kind = RunTime;
    type Static = Const<0>;
    const CONSTANT: Option<usize> = None;

    fn count(self) -> usize {
        self.0
    }
}

impl Kind for RunTime {
    type Vector<T: Element, S: StaticLength> = DVector<T>;
    type View<T: Element, S: StaticLength> = [T];
    type Halves<T: Element, S: StaticLength> = TwoParts<T>;
    type Spare<T: Element> = Vec<TwoParts<T>>;

    fn filled<T: Element, S: StaticLength>(count: usize, x: T) -> DVector<T> {
        DVector::from_element(count, x)
    }

    fn view<T: Element, S: StaticLength>(vector: &DVector<T>) -> &[T] {
        vector.as_slice()
    }

    fn halves<T: Element, S: StaticLength>(count: usize, x: T) -> TwoParts<T> {
        TwoParts(vec![x; 2 * count].into_boxed_slice())
    }

    fn join<T: Element, S: StaticLength>(
        spare: &mut Vec<TwoParts<T>>,
        first: &DVector<T>,
        second: &DVector<T>,
    ) -> TwoParts<T> {
        let Some(mut joined) = spare.pop() else {
            return TwoParts(first.iter().chain(second).copied().collect());
        };
        joined[0].copy_from_slice(first.as_slice());
        joined[1].copy_from_slice(second.as_slice());
        joined
    }

    fn lend<T: Element, S: StaticLength>(spare: &mut Vec<TwoParts<T>>, like: &TwoParts<T>) -> TwoParts<T> {
        spare.pop().unwrap_or_else(|| like.clone())
    }

    fn copy<T: Element, S: StaticLength>(to: &mut TwoParts<T>, from: &TwoParts<T>) {
        to.0.copy_from_slice(&from.0);
    }

    fn give_back<T: Element, S: StaticLength>(spare: &mut Vec<TwoParts<T>>, lent: TwoParts<T>) {
        spare.push(lent);
    }

    fn half_if_constant<T: Element, S: StaticLength>(_: &TwoParts<T>, _: usize) -> DVector<T> {
        DVector::from_vec(Vec::new())
    }

    fn flat<T: Element, S: StaticLength>(halves: &TwoParts<T>) -> &[T] {
        &halves.0
    }

    fn flat_mut<T: Element, S: StaticLength>(halves: &mut TwoParts<T>) -> &mut [T] {
        &mut halves.0
    }
}

/// Two vectors of one length, in one piece.
#[derive(Debug, PartialEq)]
pub struct TwoParts<T>(Box<[T]>);

/// What is cloned to has its memory reused.
impl<T: Clone> Clone for TwoParts<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }

    fn clone_from(&mut self, source: &Self) {
        self.0.clone_from(&source.0);
    }
}

impl<T> Index<usize> for TwoParts<T> {
    type Output = [T];

    fn index(&self, half: usize) -> &[T] {
        let (first, second) = self.0.split_at(self.0.len() / 2);
        if half == 0 { first } else { second }
    }
}

impl<T> IndexMut<usize> for TwoParts<T> {
    fn index_mut(&mut self, half: usize) -> &mut [T] {
        let (first, second) = self.0.split_at_mut(self.0.len() / 2);
        if half == 0 { first } else { second }
    }
}

impl<T: Element> Numbers<T> for DVector<T> {
    const COUNT: Option<usize> = None;

    fn entries(&self) -> &[T] {
        self.as_slice()
    }

    fn entries_mut(&mut self) -> &mut [T] {
        self.as_mut_slice()
    }

    fn copy_from(&mut self, other: &Self) {
        if self.len() == other.len() {
            self.as_mut_slice().copy_from_slice(other.as_slice());
        } else {
            *self = other.clone();
        }
    }

    fn from_entries(entries: &[T]) -> Self {
        Self::from_column_slice(entries)
    }
}
