//! Operation counts of functions.

use std::fmt;

/// Maximum number of operations of an emitted function. A longer function is an error.
pub(super) const OPERATION_LIMIT: usize = 50_000;

/// Operation count of a function. `arithmetic` counts each + − × ÷ √ as 1; elementary functions count separately.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct Count {
    pub(crate) arithmetic: usize,
    pub(crate) functions: usize,
    /// Number of results of user-supplied functions.
    pub(crate) calls: usize,
}

impl Count {
    /// Total without user-supplied functions, whose cost is unknown.
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
