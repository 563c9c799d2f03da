//! Methods of systems with constraints: the rows F, their names, and M⁻¹.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::ManyEmitter;
use crate::mechanics::many::{ConstraintRow, ManyConstraint, Scatter, element};
use crate::resolve::many::Slot;
use crate::symbolic::Id;
use crate::syntax::numbers;

impl ManyEmitter<'_> {
    /// Methods of `ManyBodies` that a system with constraints overrides; nothing without constraints.
    pub(super) fn constrained(&self, free: &TokenStream) -> TokenStream {
        if self.equations.constraints.is_empty() {
            return TokenStream::new();
        }
        let (scalar, lengths) = (self.style.types.scalar, self.style.lengths());
        let solved = self.equations.inertia.iter().map(|block| self.solve(block));
        let rows = self.equations.constraints.iter().map(|constraint| self.rows(constraint));
        let name = self.write_constraint_name();
        let correct = self.equations.band.iter().map(|band| self.correct(band));
        quote! {
            fn free_accelerations(&self, t: #scalar, q: &[#scalar], v: &[#scalar], a: &mut [#scalar]) {
                #free
            }

            fn divide_by_masses(&self, t: #scalar, q: &[#scalar], v: &[#scalar], forces: &mut [#scalar]) {
                #lengths
                let cells = ::core::cell::Cell::from_mut(forces).as_slice_of_cells();
                #(#solved)*
            }

            fn constraints(
                &self,
                t: #scalar,
                q: &[#scalar],
                v: &[#scalar],
                rows: &mut __lagrange::ConstraintRows<#scalar>,
            ) {
                #lengths
                #({ #rows })*
            }

            #(#correct)*

            #name
        }
    }

    /// Loops that state the rows of a constraint.
    fn rows(&self, constraint: &ManyConstraint) -> TokenStream {
        let roots: Vec<Id> = constraint.rows.iter().flat_map(ConstraintRow::roots).collect();
        self.rows_from(constraint, &roots, 0)
    }

    fn rows_from(&self, constraint: &ManyConstraint, roots: &[Id], level: usize) -> TokenStream {
        let Some(range) = constraint.ranges.get(level) else {
            return constraint.rows.iter().map(|row| self.row(row, level)).collect();
        };
        self.loop_of_rows((level, range), roots, || self.rows_from(constraint, roots, level + 1))
    }

    /// A loop that computes `roots`, after the sums in them that do not change in it.
    fn loop_of_rows(
        &self,
        (level, range): (usize, &crate::resolve::many::Range),
        roots: &[Id],
        inner: impl FnOnce() -> TokenStream,
    ) -> TokenStream {
        let mark = self.mark();
        let before = self.sums_before(roots, level);
        let nothing = TokenStream::new();
        let rows = self.one_loop((level, range), (roots, &[]), inner, [&nothing, &nothing]);
        self.forget(mark);
        quote! { #before #rows }
    }

    /// A row and its coefficients.
    fn row(&self, row: &ConstraintRow, depth: usize) -> TokenStream {
        let (own, others): (Vec<&Scatter>, Vec<&Scatter>) =
            row.slopes.iter().partition(|part| part.ranges.len() == depth);
        let slots: Vec<usize> = own.iter().flat_map(|part| &part.values).map(|(slot, _)| *slot).collect();
        let slopes = own.iter().flat_map(|part| &part.values).map(|(_, slope)| *slope);
        let roots: Vec<Id> = row.residual.into_iter().chain([row.rate, row.bias]).chain(slopes).collect();
        let (statements, results) = self.values(&roots);
        let (residual, rest) = results.split_at(results.len() - 2 - slots.len());
        let residual = match residual {
            [residual] => quote!(::core::option::Option::Some(#residual)),
            _ => quote!(::core::option::Option::None),
        };
        let (rate, bias) = (&rest[0], &rest[1]);
        let entries = slots.iter().zip(&rest[2..]).map(|(slot, slope)| self.entry(*slot, slope));
        let loops = others.iter().map(|part| self.entries(part, depth));
        quote! {
            {
                #statements
                rows.row(#residual, #rate, #bias);
                #(#entries)*
            }
            #({ #loops })*
        }
    }

    /// Loops that state coefficients.
    fn entries(&self, part: &Scatter, level: usize) -> TokenStream {
        let slopes: Vec<Id> = part.values.iter().map(|(_, slope)| *slope).collect();
        let Some(range) = part.ranges.get(level) else {
            let (statements, results) = self.values(&slopes);
            let entries = part.values.iter().zip(&results).map(|((slot, _), slope)| self.entry(*slot, slope));
            return quote! { #statements #(#entries)* };
        };
        self.loop_of_rows((level, range), &slopes, || self.entries(part, level + 1))
    }

    fn entry(&self, slot: usize, slope: &TokenStream) -> TokenStream {
        let slot = &self.problem.many.slots[slot];
        let (element, own) = element(&self.equations.inertia, slot);
        let places = element
            .into_iter()
            .map(|(array, number)| self.style.place_of_slot(&Slot { array, number, ..slot.clone() }));
        let own = Literal::usize_unsuffixed(own);
        quote! { rows.entry([#(#places),*], #own, #slope); }
    }

    fn write_constraint_name(&self) -> TokenStream {
        let lengths = self.style.lengths();
        let constraints = self.equations.constraints.iter().map(|constraint| {
            let slot = &self.problem.many.slots[constraint.rows[0].multiplier];
            let array = self.problem.many.array(slot.array);
            let brackets = slot.indices.len() + array.lengths.len();
            let format = format!("{}{}", array.name, "[{}]".repeat(brackets));
            let outer = slot.indices.iter().map(|index| self.style.index(index));
            let inner = (0..array.lengths.len()).map(|axis| {
                let (length, behind) = (array.lengths[axis], numbers(&array.lengths[axis + 1..]));
                let [length, behind] = [length, behind].map(Literal::usize_unsuffixed);
                quote!(rest / #behind % #length)
            });
            let count = Literal::usize_unsuffixed(constraint.rows.len());
            let one = quote! {
                if rest < #count {
                    return ::core::write!(to, #format #(, #outer)* #(, #inner)*);
                }
                rest -= #count;
            };
            self.style.nested(&constraint.ranges, one)
        });
        quote! {
            fn write_constraint_name(
                &self,
                constraint: usize,
                to: &mut dyn ::core::fmt::Write,
            ) -> ::core::fmt::Result {
                #lengths
                let mut rest = constraint;
                #(#constraints)*
                ::core::result::Result::Ok(())
            }
        }
    }
}
