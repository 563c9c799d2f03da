//! How many operations a function takes.

use std::fmt;

/// Longer functions are refused.
pub(super) const OPERATION_LIMIT: usize = 50_000;

/// How many operations a function takes: + − × ÷ √ count 1, elementary functions apart.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct Count {
    pub(crate) arithmetic: usize,
    pub(crate) functions: usize,
    /// Results of functions that the user supplies.
    pub(crate) calls: usize,
}

impl Count {
    /// Supplied functions are not ours to count.
    pub(super) fn total(self) -> usize {
        self.arithmetic + self.functions
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { arithmetic, functions, calls } = *self;
        let plural = |count| if count == 1 { "" } else { "s" };
        write!(f, "{arithmetic} operation{} (+ − × ÷ √), ", plural(arithmetic))?;
        write!(f, "{functions} elementary function{}", plural(functions))?;
        match calls {
            0 => Ok(()),
            calls => write!(f, ", {calls} result{} of supplied functions", plural(calls)),
        }
    }
}
