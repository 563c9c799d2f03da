//! Recursions: the values that they carry along their elements, and the sweeps that eliminate them.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use super::ManyEmitter;
use super::indices::round;
use crate::codegen::style::FunctionContext;
use crate::mechanics::many::{Recursion, Step};
use crate::resolve::many::{Affine, Index, Slot, Unknown};
use crate::symbolic::Id;
use crate::variables::Variable;

/// Name of a local of the emitted functions.
fn local(name: &str) -> Ident {
    Ident::new(name, Span::mixed_site())
}

impl ManyEmitter<'_> {
    /// A trait of the emitted code alone, whose function appends what the recursions define to coordinates and velocities.
    pub(super) fn extension(&self, implementation: &TokenStream) -> TokenStream {
        let Some(recursion) = &self.equations.recursion else { return TokenStream::new() };
        let (scalar, lengths) = (self.style.types.scalar, self.style.lengths());
        let scan = self.scan(recursion);
        let vector = quote!(&mut __lagrange::generated::Vec<__T>);
        let concrete = quote!(&mut __lagrange::generated::Vec<#scalar>);
        quote! {
            trait __Extended<__T> {
                fn extend(&self, t: __T, q: #vector, v: #vector);
            }

            #[automatically_derived]
            #[allow(clippy::all, clippy::pedantic, clippy::nursery, unused_parens, unused_variables, non_snake_case)]
            #implementation {
                fn extend(&self, t: #scalar, q: #concrete, v: #concrete) {
                    #lengths
                    #scan
                }
            }
        }
    }

    /// A function body at `state`, with `t`, `q` and `v`, which contain what recursions define.
    pub(super) fn at_state(&self, body: &TokenStream) -> TokenStream {
        if self.equations.recursion.is_none() {
            return quote! {
                let (t, q, v) = (state.t, state.q.as_slice(), state.v.as_slice());
                #body
            };
        }
        let scalar = self.style.types.scalar;
        let all = local("all");
        quote! {
            let t = state.t;
            __lagrange::generated::with_scratch(|#all: &mut [__lagrange::generated::Vec<#scalar>; 2]| {
                let [q, v] = #all;
                __lagrange::generated::copy([state.q.as_slice(), state.v.as_slice()], [&mut *q, &mut *v]);
                __Extended::extend(self, t, q, v);
                let (q, v) = (&q[..], &v[..]);
                #body
            })
        }
    }

    /// Statements that append the values and the rates of the recursions to the vectors `q` and `v`.
    fn scan(&self, recursion: &Recursion) -> TokenStream {
        let (count, zero) = (self.style.count_with_recursions(), self.style.constant(0.0));
        let (first, next) = self.ends(recursion, |step, own| {
            let (statements, results) = self.values(&[&step.values[..], &step.rates].concat());
            let own = Index::Affine(own);
            let places: Vec<TokenStream> =
                recursion.carried.iter().map(|row| self.place(row, &own)).collect();
            let (values, rates) = results.split_at(places.len());
            quote! {
                #statements
                #(q[#places] = #values; v[#places] = #rates;)*
            }
        });
        quote! {
            q.resize(#count, #zero);
            v.resize(#count, #zero);
            #first
            #next
        }
    }

    /// The first element, if there is one, and a loop over those behind it.
    fn ends(
        &self,
        recursion: &Recursion,
        step: impl Fn(&Step, Affine) -> TokenStream,
    ) -> (TokenStream, TokenStream) {
        let (index, length) = (round(0), self.style.bound(&recursion.length));
        let first = step(&recursion.first, Affine::number(0));
        let next = step(&recursion.next, Affine::of(Unknown::Level(0)));
        let first = quote! {
            if #length > 0 {
                let #index: usize = 0;
                #first
            }
        };
        (first, quote! { for #index in 1..#length { #next } })
    }

    /// The same from the last element to the first.
    fn backward(&self, recursion: &Recursion, step: impl Fn(&Step, Affine) -> TokenStream) -> TokenStream {
        let (index, length) = (round(0), self.style.bound(&recursion.length));
        let first = step(&recursion.first, Affine::number(0));
        let next = step(&recursion.next, Affine::of(Unknown::Level(0)));
        quote! {
            for #index in (1..#length).rev() { #next }
            if #length > 0 {
                let #index: usize = 0;
                #first
            }
        }
    }

    /// Place of a number of an element.
    fn place(&self, &(array, number): &(usize, usize), index: &Index) -> TokenStream {
        self.style.place_of_slot(&Slot { array, indices: vec![index.clone()], number })
    }

    /// Statements that write the accelerations to `a`.
    pub(super) fn eliminated(&self, recursion: &Recursion) -> TokenStream {
        let (scalar, lengths, zero) =
            (self.style.types.scalar, self.style.lengths(), self.style.constant(0.0));
        let (length, width) =
            (self.style.bound(&recursion.length), Literal::usize_unsuffixed(recursion.width()));
        let [all, rows, behind] = ["all", "rows", "behind"].map(local);
        let [places, speeds, forces, memory] = ["places", "speeds", "forces", "memory"].map(local);
        let extended = self.reads_recursions(recursion).then(|| {
            quote! {
                __lagrange::generated::copy([q, v], [&mut *#places, &mut *#speeds]);
                __Extended::extend(self, t, #places, #speeds);
                let (q, v) = (&#places[..], &#speeds[..]);
            }
        });
        let scatters = self.scatters(&self.equations.forcing);
        let solved = self.equations.inertia.iter().map(|block| self.solve(block));
        let backward = self.backward(recursion, |step, own| self.eliminate(recursion, step, own));
        let (first, next) = self.ends(recursion, |step, own| self.accelerate(recursion, step, own));
        let count = self.style.count_with_recursions();
        let terms = Literal::usize_unsuffixed(recursion.behind.len());
        let (behind, emptied) = match recursion.is_chain() {
            true => (quote! { let mut #behind = [#zero; #terms]; }, TokenStream::new()),
            false => (TokenStream::new(), quote! { #memory.clear(); }),
        };
        quote! {
            #lengths
            __lagrange::generated::with_scratch(|#all: &mut [__lagrange::generated::Vec<#scalar>; 4]| {
                let [#places, #speeds, #forces, #memory] = #all;
                #extended
                #emptied
                #memory.resize(#length * #width, #zero);
                let #rows = #memory.as_chunks_mut::<#width>().0;
                #forces.resize(#count, #zero);
                let cells = ::core::cell::Cell::from_mut(&mut #forces[..]).as_slice_of_cells();
                #scatters
                #(#solved)*
                #behind
                #backward
                #first
                #next
                for (a, cell) in a.iter_mut().zip(cells) {
                    *a = cell.get();
                }
            });
        }
    }

    /// True if the forces, the mass matrix or ∂f/∂q depend on numbers that a recursion defines, so that these have to be computed first.
    fn reads_recursions(&self, recursion: &Recursion) -> bool {
        let many = &self.problem.many;
        let forces =
            self.equations.forcing.iter().flat_map(|scatter| &scatter.values).map(|(_, value)| *value);
        let guarded =
            recursion.guarded.iter().chain(self.equations.inertia.iter().flat_map(|block| &block.guarded));
        let guarded = guarded.flat_map(|guarded| &guarded.values).map(|(_, value)| *value);
        let blocks = self.equations.inertia.iter().flat_map(|block| block.equations.forms[0].matrix.concat());
        let steps = [&recursion.first, &recursion.next].into_iter().flat_map(|step| {
            let kept = step.kept.iter().map(|(_, entry)| *entry);
            kept.chain(step.to_parent.iter().copied()).chain(step.pivots.concat()).collect::<Vec<_>>()
        });
        let all: Vec<Id> = forces.chain(guarded).chain(blocks).chain(steps).collect();
        let graph = self.style.graph;
        let is_defined = |symbol| match Variable::of(symbol) {
            Variable::Coordinate(k) | Variable::Velocity(k) => many.is_recursion(many.slots[k].array),
            _ => false,
        };
        graph.symbols(&many.with_bodies(graph, &all)).any(is_defined)
    }

    /// Eliminates an element.
    fn eliminate(&self, recursion: &Recursion, step: &Step, own: Affine) -> TokenStream {
        let is_first = own.as_number().is_some();
        let own = Index::Affine(own);
        let guarded = recursion.guarded.iter().map(|guarded| self.guarded(guarded));
        let kept = self.keep(recursion, step);
        let behind = self.bind_behind(recursion);
        let forces = self.bind_cells(&recursion.forces[0], &recursion.coordinates, &own);
        let pulls = self.bind_cells(&recursion.forces[1], &recursion.carried, &own);
        let to_parent: &[Id] = if is_first { &[] } else { &step.to_parent };
        let pivots = self.pivots(recursion, step);
        let roots = [&step.solved.concat()[..], to_parent].concat();
        let (statements, results) = self.values(&roots);
        let (multiples, rest) = results.split_at(recursion.solved[0].len());
        let (constants, to_parent) = rest.split_at(recursion.solved[1].len());
        let [of_multiples, of_constants] =
            recursion.solved.each_ref().map(|terms| terms.iter().map(|&term| recursion.offset(term)));
        let passed_on = (!is_first).then(|| self.pass_on(recursion, to_parent));
        let [rows, element, trusted] = ["rows", "element", "trusted"].map(local);
        let (index, zero) = (round(0), self.style.constant(0.0));
        quote! {
            let #element = &mut #rows[#index];
            #(#guarded)*
            #kept
            #behind
            #forces
            #pulls
            #pivots
            #statements
            #(#element[#of_multiples] = #multiples;)*
            #(#element[#of_constants] = #constants + #zero / #trusted;)*
            #passed_on
        }
    }

    /// Computes the entries of G, J and γ, and keeps them in the row of the element.
    fn keep(&self, recursion: &Recursion, step: &Step) -> TokenStream {
        let element = local("element");
        let (terms, entries): (Vec<usize>, Vec<Id>) = step.kept.iter().copied().unzip();
        let (statements, results) = self.values(&entries);
        let names = terms.iter().map(|&term| &self.style.names[&Variable::Term(term).symbol()]);
        let names: Vec<&Ident> = names.collect();
        let offsets = terms.iter().map(|&term| recursion.offset(term));
        quote! {
            #statements
            #(let #names = #results;)*
            #(#element[#offsets] = #names;)*
        }
    }

    /// `let` statements that read the sums over the elements behind one. In a chain the last iteration passed them on.
    fn bind_behind(&self, recursion: &Recursion) -> TokenStream {
        match recursion.is_chain() {
            true => {
                let (behind, places) =
                    (local("behind"), (0..recursion.behind.len()).map(Literal::usize_unsuffixed));
                let names =
                    recursion.behind.iter().map(|&term| &self.style.names[&Variable::Term(term).symbol()]);
                quote! { #(let #names = #behind[#places];)* }
            }
            false => self.bind_row(recursion, recursion.behind.iter().copied()),
        }
    }

    /// Reciprocals of the pivots, zero for one that is not to be trusted, so that the elements before it are not lost with it.
    fn pivots(&self, recursion: &Recursion, step: &Step) -> TokenStream {
        let (one, trusted) = (self.style.constant(1.0), local("trusted"));
        let pivots = step.pivots.iter().zip(&recursion.reciprocals).map(|(pivot, &term)| {
            let (statements, results) = self.values(pivot);
            let name = &self.style.names[&Variable::Term(term).symbol()];
            let [pivot, whole, trust] = ["pivot", "whole", "trust"].map(local);
            quote! {
                #statements
                let (#pivot, #whole) = (#(#results),*);
                let #trust = __lagrange::generated::trust(#pivot, #whole);
                let #trusted = #trusted * #trust;
                let #name = __lagrange::generated::only_where(#trust, #one / #pivot);
            }
        });
        quote! { let #trusted = #one; #(#pivots)* }
    }

    fn pass_on(&self, recursion: &Recursion, to_parent: &[TokenStream]) -> TokenStream {
        let [rows, behind, parent] = ["rows", "behind", "parent"].map(local);
        if recursion.is_chain() {
            return quote! { #behind = [#(#to_parent),*]; };
        }
        let at = self.style.index(&recursion.parent);
        let offsets: Vec<Literal> = recursion.behind.iter().map(|&term| recursion.offset(term)).collect();
        quote! {
            let #parent = &mut #rows[#at];
            #(#parent[#offsets] = #parent[#offsets] + #to_parent;)*
        }
    }

    /// Writes the accelerations of an element, from those of its parent.
    fn accelerate(&self, recursion: &Recursion, step: &Step, own: Affine) -> TokenStream {
        let (rows, index, element) = (local("rows"), round(0), local("element"));
        let is_first = own.as_number().is_some();
        let solved = recursion.solved.concat();
        let bound = self.bind_row(recursion, step.kept.iter().map(|(term, _)| *term).chain(solved));
        let before =
            (!is_first).then(|| self.bind_cells(&recursion.before, &recursion.carried, &recursion.parent));
        let (statements, results) = self.values(&step.accelerations.concat());
        let rows_of_element = recursion.coordinates.iter().chain(&recursion.carried);
        let places = rows_of_element.map(|row| self.place(row, &Index::Affine(own.clone())));
        quote! {
            let #element = &#rows[#index];
            #bound
            #before
            #statements
            #(cells[#places].set(#results);)*
        }
    }

    /// `let` statements that read terms from the row of an element.
    fn bind_row(&self, recursion: &Recursion, terms: impl Iterator<Item = usize> + Clone) -> TokenStream {
        let element = local("element");
        let names = terms.clone().map(|term| &self.style.names[&Variable::Term(term).symbol()]);
        let offsets = terms.map(|term| recursion.offset(term));
        quote! { #(let #names = #element[#offsets];)* }
    }

    /// `let` statements that read terms from the numbers of an element in `cells`.
    fn bind_cells(&self, terms: &[usize], rows: &[(usize, usize)], index: &Index) -> TokenStream {
        let names = terms.iter().map(|&term| &self.style.names[&Variable::Term(term).symbol()]);
        let places = rows.iter().map(|row| self.place(row, index));
        quote! { #(let #names = cells[#places].get();)* }
    }

    /// Statements that add to the momenta in `cells` what recursions contribute: Jᵀ of what is carried, from the last element on.
    pub(super) fn momenta_of_recursion(&self) -> TokenStream {
        let Some(recursion) = &self.equations.recursion else { return TokenStream::new() };
        self.backward(recursion, |step, own| {
            let is_first = own.as_number().is_some();
            let own = Index::Affine(own);
            let targets = [(&recursion.carried, &recursion.parent), (&recursion.coordinates, &own)];
            let momenta: Vec<Ident> = (0..recursion.carried.len())
                .map(|k| format_ident!("momentum{k}", span = Span::mixed_site()))
                .collect();
            let places = recursion.carried.iter().map(|row| self.place(row, &own));
            let mut entries: Vec<(Id, TokenStream, &Ident)> = Vec::new();
            for ((rows, index), slopes) in targets.into_iter().zip(&step.slopes).skip(usize::from(is_first)) {
                for (row, momentum) in slopes.iter().zip(&momenta) {
                    let own = row.iter().zip(rows.iter()).filter(|(slope, _)| **slope != Id::ZERO);
                    entries.extend(own.map(|(slope, at)| (*slope, self.place(at, index), momentum)));
                }
            }
            let roots: Vec<Id> = entries.iter().map(|(slope, ..)| *slope).collect();
            let (statements, results) = self.values(&roots);
            let at: Vec<&TokenStream> = entries.iter().map(|(_, at, _)| at).collect();
            let of = entries.iter().map(|(.., momentum)| *momentum);
            quote! {
                #(let #momenta = cells[#places].get();)*
                #statements
                #(cells[#at].set(cells[#at].get() + #results * #of);)*
            }
        })
    }
}

impl FunctionContext<'_> {
    /// Number of all coordinates and of the numbers that recursions define.
    fn count_with_recursions(&self) -> TokenStream {
        let counts = self.problem.many.arrays.iter().map(|array| self.count(array));
        quote!(#(#counts)+*)
    }
}

impl Recursion {
    /// True if each element is defined from the one before it.
    fn is_chain(&self) -> bool {
        self.parent == Index::Affine(Affine::of(Unknown::Level(0)).plus_number(-1))
    }

    /// Terms that the row of an element holds during the elimination.
    fn in_row(&self) -> Vec<usize> {
        let mut kept: Vec<usize> = [&self.first, &self.next]
            .into_iter()
            .flat_map(|step| &step.kept)
            .map(|(term, _)| *term)
            .collect();
        kept.sort_unstable();
        kept.dedup();
        let behind = if self.is_chain() { &[] } else { &self.behind[..] };
        [behind, &self.solved[0], &self.solved[1], &kept].concat()
    }

    fn width(&self) -> usize {
        self.in_row().len()
    }

    /// Place of a term in the row of an element.
    fn offset(&self, term: usize) -> Literal {
        let place = self.in_row().iter().position(|&known| known == term);
        Literal::usize_unsuffixed(place.unwrap_or_default())
    }
}
