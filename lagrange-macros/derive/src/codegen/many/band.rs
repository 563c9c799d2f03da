//! Corrections by constraints between neighbours: rows and inverse masses, position by position.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use super::ManyEmitter;
use super::indices::{round, start_name};
use crate::codegen::solving::solve;
use crate::mechanics::many::{Band, ConstraintRow, Inertia, ManyConstraint, Place};
use crate::resolve::many::Affine;
use crate::symbolic::Id;
use crate::syntax::numbers;
use crate::variables::Variable;

/// Variable of the emitted closures.
fn variable(name: &str) -> Ident {
    Ident::new(name, Span::mixed_site())
}

fn row_name(lane: usize, row: usize) -> Ident {
    format_ident!("row{lane}_{row}", span = Span::mixed_site())
}

fn first_name(constraint: usize) -> Ident {
    format_ident!("first{constraint}", span = Span::mixed_site())
}

impl ManyEmitter<'_> {
    /// The method `correct` of a system whose constraints have a band.
    pub(super) fn correct(&self, band: &Band) -> TokenStream {
        let (scalar, lengths) = (self.style.types.scalar, self.style.lengths());
        let constraints = &self.equations.constraints;
        let rows = band.rows(constraints);
        let sizes = [rows, band.elements, band.coordinates.len(), rows * band.elements - 1];
        let sizes = sizes.map(Literal::usize_unsuffixed);
        let [position, element, before] = ["position", "element", "before"].map(variable);
        let starts: Vec<Ident> = (0..constraints.len()).map(first_name).collect();
        let counts = constraints.iter().map(|constraint| {
            let (rows, count) =
                (Literal::usize_unsuffixed(constraint.rows.len()), self.rounds_of(constraint));
            quote!(#count * #rows)
        });
        let ends = band.lanes.iter().flatten().map(|place| self.positions(band, place));
        let places = band.coordinates.iter().map(|&(array, number)| {
            let start = (array > 0).then(|| start_name(array)).into_iter();
            let inner = Literal::usize_unsuffixed(numbers(&self.problem.many.arrays[array].lengths));
            let number = Literal::usize_unsuffixed(number);
            quote!(#element.wrapping_mul(#inner).wrapping_add(#(#start +)* #number))
        });
        let all = band.lanes.iter().enumerate().flat_map(|(number, lane)| {
            (0..constraints[lane[0].constraint].rows.len()).map(move |row| row_name(number, row))
        });
        let lanes = band.lanes.iter().enumerate().map(|lane| self.lane(band, lane, &position));
        let before_first = Literal::usize_unsuffixed(band.elements - 1);
        let masses = self.inverse_masses(band, &element);
        quote! {
            fn correct(
                &self,
                (t, q, v): (#scalar, &[#scalar], &[#scalar]),
                target: __lagrange::Correction,
                (x, multipliers): (&mut [#scalar], &mut __lagrange::generated::Vec<#scalar>),
            ) -> #scalar {
                #lengths
                let mut #before: usize = 0;
                #(let #starts: usize = #before; #before += #counts;)*
                let ends = __lagrange::generated::around([#(#ends),*]);
                __lagrange::generated::Band::<#(#sizes),*>::correct(
                    (ends, #before),
                    #[inline(always)] |#element: usize| {
                        let #element = #element.wrapping_sub(#before_first);
                        [#(#places),*]
                    },
                    #[inline(always)] |#position: usize| {
                        #(#lanes)*
                        [#(#all),*]
                    },
                    #[inline(always)] |#element: usize| {
                        let #element = #element.wrapping_sub(#before_first);
                        #masses
                    },
                    (target, x, multipliers),
                )
            }
        }
    }

    /// Number of rounds of a constraint.
    fn rounds_of(&self, constraint: &ManyConstraint) -> TokenStream {
        match constraint.ranges.first() {
            Some(range) => {
                let range = self.style.range(range);
                quote!((#range).len())
            }
            None => quote!(1),
        }
    }

    /// Positions of a constraint, counted from the first that a band may have.
    fn positions(&self, band: &Band, place: &Place) -> TokenStream {
        let offset = place.offset + band.elements as i64 - 1;
        let bound = |bound: &Affine| self.style.bound(&bound.plus_number(offset));
        let (from, to) = (bound(&place.rounds.from), bound(&place.rounds.to));
        quote!(#from..#to)
    }

    /// Binds the rows of the constraints of a lane at a position, each `None` where there is none.
    fn lane(&self, band: &Band, (number, lane): (usize, &Vec<Place>), position: &Ident) -> TokenStream {
        let count = self.equations.constraints[lane[0].constraint].rows.len();
        let names = (0..count).map(|row| row_name(number, row));
        let nothing = (0..count).map(|_| quote!(::core::option::Option::None));
        let rows = lane.iter().map(|place| self.rows_at_position(band, place, position));
        quote! {
            let [#(#names),*] = #(#rows else)* { [#(#nothing),*] };
        }
    }

    /// The rows of a constraint, if it has some at a position.
    fn rows_at_position(&self, band: &Band, place: &Place, position: &Ident) -> TokenStream {
        let (constraint, start) =
            (&self.equations.constraints[place.constraint], first_name(place.constraint));
        let roots: Vec<Id> = constraint.rows.iter().flat_map(ConstraintRow::roots).collect();
        let (statements, results) = self.values(&roots);
        let mut results = results.into_iter();
        let count = Literal::usize_unsuffixed(constraint.rows.len());
        let (round, from) = (round(0), self.style.bound(&place.rounds.from));
        let rows = constraint.rows.iter().enumerate().map(|(number, row)| {
            let number = Literal::usize_unsuffixed(number);
            let row = self.band_row(band, place, row, &mut results);
            quote! {
                ::core::option::Option::Some(__lagrange::generated::BandRow::new(
                    #start + (#round - #from) * #count + #number, #row
                ))
            }
        });
        let rows: Vec<TokenStream> = rows.collect();
        let offset = place.offset + band.elements as i64 - 1;
        let (positions, less) = (self.positions(band, place), Literal::u64_unsuffixed(offset.unsigned_abs()));
        let of_position = match offset {
            ..0 => quote!(#position + #less),
            _ => quote!(#position - #less),
        };
        quote! {
            if (#positions).contains(&#position) {
                let #round: usize = #of_position;
                #statements
                [#(#rows),*]
            }
        }
    }

    /// Residual, rate, bias and coefficients of a row, from the values of its expressions in turn.
    fn band_row(
        &self,
        band: &Band,
        place: &Place,
        row: &ConstraintRow,
        results: &mut impl Iterator<Item = TokenStream>,
    ) -> TokenStream {
        let residual = match row.residual {
            Some(_) => {
                let residual = results.next();
                quote!(::core::option::Option::Some(#residual))
            }
            None => quote!(::core::option::Option::None),
        };
        let (rate, bias) = (results.next(), results.next());
        let zero = self.style.constant(0.0);
        let mut slopes: Vec<Vec<Option<TokenStream>>> =
            vec![vec![None; band.coordinates.len()]; band.elements];
        for (slot, _) in row.slopes.iter().flat_map(|part| &part.values) {
            let slot = &self.problem.many.slots[*slot];
            let constraint = &self.equations.constraints[place.constraint];
            let offset = constraint.offset(slot, &place.rounds).unwrap_or(place.offset) - place.offset;
            let coordinate = band.coordinates.iter().position(|known| *known == (slot.array, slot.number));
            let (Some(coordinate), Some(value)) = (coordinate, results.next()) else { continue };
            let entry = &mut slopes[offset as usize][coordinate];
            *entry = Some(match entry.take() {
                Some(known) => quote!(#known + #value),
                None => value,
            });
        }
        let elements = slopes.into_iter().map(|element| {
            let entries = element.into_iter().map(|entry| entry.unwrap_or_else(|| zero.clone()));
            quote!([#(#entries),*])
        });
        quote!(#residual, #rate, #bias, [#(#elements),*])
    }

    /// Inverse masses of the coordinates of an element: numbers if M is diagonal, else the columns of its inverse.
    fn inverse_masses(&self, band: &Band, element: &Ident) -> TokenStream {
        let (zero, one) = (self.style.constant(0.0), self.style.constant(1.0));
        let size = band.coordinates.len();
        let block_of = |coordinate: (usize, usize)| {
            let place = |block: &Inertia| block.rows.iter().position(|row| *row == coordinate);
            self.equations.inertia.iter().find_map(|block| Some((block, place(block)?)))
        };
        let is_diagonal = band
            .coordinates
            .iter()
            .all(|&coordinate| block_of(coordinate).is_some_and(|(block, _)| block.is_diagonal()));
        let column = |own: Option<usize>| {
            let entries = band.coordinates.iter().map(|&coordinate| {
                let Some((block, row)) = block_of(coordinate) else { return zero.clone() };
                let is_other = |own: usize| {
                    block_of(band.coordinates[own]).is_none_or(|(other, _)| !std::ptr::eq(other, block))
                };
                if own.is_some_and(is_other) {
                    return zero.clone();
                }
                let force = |of: &(usize, usize)| match own {
                    Some(own) if band.coordinates[own] != *of => zero.clone(),
                    _ => one.clone(),
                };
                let forces: Vec<TokenStream> = block.rows.iter().map(force).collect();
                self.acceleration(block, &forces, row)
            });
            let entries: Vec<TokenStream> = entries.collect();
            quote!([#(#entries),*])
        };
        let (values, nothing) = match is_diagonal {
            true => (column(None), quote!([#zero; #size])),
            false => {
                let columns = (0..size).map(|own| column(Some(own)));
                (quote!([#(#columns),*]), quote!([[#zero; #size]; #size]))
            }
        };
        let (round, length) = (round(0), self.style.bound(&band.length));
        quote! {
            if #element < #length {
                let #round: usize = #element;
                #values
            } else {
                #nothing
            }
        }
    }

    /// Acceleration of a coordinate of an element by forces on all its coordinates.
    fn acceleration(&self, block: &Inertia, forces: &[TokenStream], row: usize) -> TokenStream {
        let (equations, form) = (&block.equations, &block.equations.forms[0]);
        let names = (0..forces.len()).map(|row| &self.style.names[&Variable::Forcing(row).symbol()]);
        let guarded = block.guarded.iter().map(|guarded| self.guarded(guarded));
        let Some(program) = solve(self.style.graph, form, equations) else { return TokenStream::new() };
        let (statements, results) = self.results(&form.matrix.concat(), &program.fused());
        let result = &results[row];
        quote! {{
            #(#guarded)*
            #(let #names = #forces;)*
            #statements
            #result
        }}
    }
}
