//! Scratch memory for functions that take a shared reference and must not allocate at each call.

#[cfg(feature = "std")]
use alloc::{boxed::Box, vec::Vec};
#[cfg(feature = "std")]
use core::{any::Any, cell::RefCell};

#[cfg(feature = "std")]
std::thread_local! {
    /// For each type of scratch memory a `Vec<S>`: those that no call on this thread uses.
    static UNUSED: RefCell<Vec<Box<dyn Any>>> = const { RefCell::new(Vec::new()) };
}

/// Calls a function with scratch memory, in which it finds what an earlier call left. Memory is kept for later calls on the same thread:
/// once calls have been nested as deeply, no new one is made. Without `std` each call has a new one.
pub fn with_scratch<S: Default + 'static, R>(function: impl FnOnce(&mut S) -> R) -> R {
    #[cfg(feature = "std")]
    let mut scratch: S = on_unused(Vec::pop).flatten().unwrap_or_default();
    #[cfg(not(feature = "std"))]
    let mut scratch = S::default();
    let result = function(&mut scratch);
    #[cfg(feature = "std")]
    on_unused(|unused| unused.push(scratch));
    result
}

/// Calls a function with the unused memory of a type; `None` while the thread ends.
#[cfg(feature = "std")]
fn on_unused<S: 'static, R>(function: impl FnOnce(&mut Vec<S>) -> R) -> Option<R> {
    let on_types = |types: &mut Vec<Box<dyn Any>>| {
        let known = types.iter().position(|unused| unused.is::<Vec<S>>());
        let place = known.unwrap_or(types.len());
        if known.is_none() {
            types.push(Box::new(Vec::<S>::new()));
        }
        types[place].downcast_mut().map(function)
    };
    UNUSED.try_with(|types| on_types(&mut types.borrow_mut())).ok().flatten()
}

#[cfg(test)]
mod tests {
    use alloc::{vec, vec::Vec};

    use super::*;

    #[test]
    fn memory_is_used_again() {
        with_scratch(|numbers: &mut Vec<i64>| numbers.push(5));
        assert_eq!(with_scratch(|numbers: &mut Vec<i64>| numbers.clone()), [5]);
    }

    /// Calls within one another have memory of their own, and find it again.
    #[test]
    fn nested_calls_share_nothing() {
        let nested = || {
            with_scratch(|outer: &mut Vec<i8>| {
                *outer = vec![1; 3];
                let inner = with_scratch(|inner: &mut Vec<i8>| {
                    *inner = vec![2; 5];
                    with_scratch(|other: &mut Vec<i16>| other.push(3));
                    assert_eq!(*inner, [2; 5]);
                    inner.as_ptr() as usize
                });
                assert_eq!(*outer, [1; 3]);
                [outer.as_ptr() as usize, inner]
            })
        };
        nested();
        let places = || {
            with_scratch(|outer: &mut Vec<i8>| {
                with_scratch(|inner: &mut Vec<i8>| {
                    [outer.as_ptr(), inner.as_ptr()].map(|place| place as usize)
                })
            })
        };
        assert_eq!(places(), places());
    }

    #[test]
    fn threads_share_nothing() {
        with_scratch(|ours: &mut Vec<u8>| {
            ours.push(1);
            let theirs = || with_scratch(|theirs: &mut Vec<u8>| theirs.push(2));
            std::thread::scope(|scope| {
                (0..2).for_each(|_| drop(scope.spawn(theirs)));
            });
            assert_eq!(*ours, [1]);
        });
    }

    /// A function that panics loses its memory alone.
    #[test]
    fn a_panic_leaves_the_others() {
        let panics = || with_scratch::<Vec<u16>, ()>(|_| panic!("on purpose"));
        assert!(std::panic::catch_unwind(panics).is_err());
        assert!(with_scratch(|numbers: &mut Vec<u16>| numbers.is_empty()));
    }
}
