//! Scratch vectors for functions that take a shared reference and must not allocate at each call.

use alloc::{boxed::Box, vec::Vec};
use core::any::Any;
use core::cell::RefCell;

use crate::number::Scalar;

std::thread_local! {
    /// For each type of number a `Vec<Vec<T>>`: the vectors that no call on this thread uses.
    static UNUSED: RefCell<Vec<Box<dyn Any>>> = const { RefCell::new(Vec::new()) };
}

/// Calls a function with a vector of `length` numbers of any value. Vectors are kept for later calls on the same thread: once calls
/// have been made with the same lengths and nested as deeply, they allocate nothing.
pub fn with_scratch<T: Scalar, R>(length: usize, function: impl FnOnce(&mut [T]) -> R) -> R {
    let mut vector: Vec<T> = on_unused(Vec::pop).flatten().unwrap_or_default();
    if vector.len() < length {
        vector.resize(length, T::constant(0.0));
    }
    let result = function(&mut vector[..length]);
    on_unused(|unused| unused.push(vector));
    result
}

/// Calls a function with the unused vectors of a type; `None` while the thread ends.
fn on_unused<T: Scalar, R>(function: impl FnOnce(&mut Vec<Vec<T>>) -> R) -> Option<R> {
    let on_types = |types: &mut Vec<Box<dyn Any>>| {
        let known = types.iter().position(|unused| unused.is::<Vec<Vec<T>>>());
        let place = known.unwrap_or(types.len());
        if known.is_none() {
            types.push(Box::new(Vec::<Vec<T>>::new()));
        }
        types[place].downcast_mut().map(function)
    };
    UNUSED.try_with(|types| on_types(&mut types.borrow_mut())).ok().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Address of a scratch vector.
    fn place<T: Scalar>(scratch: &mut [T]) -> usize {
        scratch.as_ptr() as usize
    }

    #[test]
    fn a_vector_is_used_again() {
        let first = with_scratch::<f64, _>(100, place);
        assert_eq!(with_scratch::<f64, _>(7, place), first);
        assert_eq!(with_scratch::<f64, _>(100, |scratch| scratch.len()), 100);
        with_scratch::<f64, _>(0, |scratch| assert!(scratch.is_empty()));
    }

    /// Calls within one another have vectors of their own, and find them again.
    #[test]
    fn nested_calls_share_nothing() {
        let nested = || {
            with_scratch::<f64, _>(3, |outer| {
                outer.fill(1.0);
                let inner = with_scratch::<f64, _>(5, |inner| {
                    inner.fill(2.0);
                    with_scratch::<f32, _>(4, |other| other.fill(3.0));
                    assert_eq!(inner, [2.0; 5]);
                    place(inner)
                });
                assert_eq!(outer, [1.0; 3]);
                [place(outer), inner]
            })
        };
        assert_eq!(nested(), nested());
    }

    #[test]
    fn threads_share_nothing() {
        with_scratch::<f64, _>(3, |ours| {
            ours.fill(1.0);
            let theirs = || with_scratch::<f64, _>(3, |theirs| theirs.fill(2.0));
            std::thread::scope(|scope| {
                (0..2).for_each(|_| drop(scope.spawn(theirs)));
            });
            assert_eq!(ours, [1.0; 3]);
        });
    }

    /// A function that panics loses its vector alone.
    #[test]
    fn a_panic_leaves_the_others() {
        let panics = || with_scratch::<f64, ()>(3, |_| panic!("on purpose"));
        assert!(std::panic::catch_unwind(panics).is_err());
        assert_eq!(with_scratch::<f64, _>(3, |scratch| scratch.len()), 3);
    }
}
