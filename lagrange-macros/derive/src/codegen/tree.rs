//! Emits the derivatives of the inertial forces of trees of bodies, which the runtime computes in loops over joints, and
//! the derivatives of the rest of the residual.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::emitter::{Emitter, Written};
use super::kernel::Kernel;
use super::passes::Program;
use super::shape::ResultShape;
use crate::contract::{CHANGE_BESIDE_GRADIENTS, Method};
use crate::mechanics::{BodyTree, TreeBody, TreeJoint};
use crate::symbolic::Id;

/// Numbers of a rotation matrix and an origin.
const POSE: usize = 12;
/// Numbers of a mass, a centre and an inertia by its upper triangle.
const BODY: usize = 10;

/// Number of columns in a block of the runtime.
const LANES: usize = 4;

impl BodyTree {
    /// Poses, axes, their rates, bends and bodies of a tree, a row each, and the lengths of the rows.
    pub(crate) fn numbers(&self) -> [(Vec<Vec<Id>>, usize); 5] {
        let pose = |joint: &TreeJoint| [joint.axes.concat(), joint.origin.to_vec()].concat();
        let body = |body: &TreeBody| {
            let [[a, b, c], [_, d, e], [_, _, f]] = body.inertia;
            [&[body.mass], body.centre.as_slice(), &[a, b, c, d, e, f]].concat()
        };
        [
            (self.joints.iter().map(pose).collect(), POSE),
            (self.columns.iter().map(|column| column.axis.to_vec()).collect(), 3),
            (self.columns.iter().filter_map(|column| column.rates).map(|rates| rates.concat()).collect(), 6),
            (self.bends.iter().map(|(_, bend)| bend.to_vec()).collect(), 3),
            (self.bodies.iter().map(body).collect(), BODY),
        ]
    }
}

impl Emitter<'_> {
    /// Emits the method that computes the slopes and the derivatives of a tree.
    pub(super) fn slopes_with_bodies(&self, method: &Method, slopes: &Program, tree: &BodyTree) -> Written {
        let rest = self.style.write(method.name, slopes, &[ResultShape::Vector(slopes.results.len())]);
        let bodies = self.bodies(tree);
        let signature = self.style.types.signature(method);
        let [Kernel { statements, results, doc, .. }, Kernel { statements: placed, results: numbers, .. }] =
            [&rest, &bodies];
        let results = self.style.slopes(slopes, results);
        let names =
            ["poses", "axes", "rates", "bends", "bodies", "fixed"].map(|name| format_ident!("{name}"));
        let structure = structure(tree);
        let longest = tree.joints.iter().map(|joint| joint.depth + joint.columns[1] - joint.columns[0]).max();
        let blocks = longest.unwrap_or(0).div_ceil(LANES);
        let tokens = quote! {
            #[doc = #doc]
            #[inline]
            #[allow(unused_variables)]
            #signature {
                const TREE: __lagrange::generated::Tree = #structure;
                let (accelerations, multipliers) = (&solution.accelerations, &solution.multipliers);
                let mut gradients = __lagrange::generated::MotionGradients::zero();
                {
                    #placed
                    let bodies = __lagrange::generated::TreeNumbers { #(#names: &#numbers),* };
                    gradients.add_bodies::<_, _, #blocks>(&TREE, &bodies, &state.v, accelerations);
                }
                #statements
                (#results, gradients)
            }
        };
        Written { tokens, kernels: vec![rest, bodies] }
    }

    /// Emits the methods for the change of the residual along a direction: all of it, and without that of the bodies of the tree.
    pub(super) fn residual_change_with_bodies(&self, method: &Method, programs: &[Program; 2]) -> Written {
        let beside = self.residual_change(
            &CHANGE_BESIDE_GRADIENTS,
            programs,
            Some(quote! { let slopes = &slopes.0; }),
        );
        let signature = self.style.types.signature(method);
        let scalar = self.style.types.scalar;
        let tokens = quote! {
            fn motion_gradients(slopes: &Self::Slopes) -> ::core::option::Option<&__lagrange::generated::MotionGradients<#scalar, Self::N>> {
                ::core::option::Option::Some(&slopes.1)
            }

            #signature {
                let mut change = self.residual_change_beside_gradients(slopes, direction);
                slopes.1.add_along(direction, &mut change.motion);
                change
            }
        };
        [beside, Written { tokens, kernels: Vec::new() }].into_iter().collect()
    }

    /// Compiles the numbers of a tree.
    fn bodies(&self, tree: &BodyTree) -> Kernel {
        let parts = tree.numbers();
        let matrices = parts.iter().map(|(rows, length)| ResultShape::Matrix(rows.len(), *length));
        let shapes: Vec<_> = matrices.chain([ResultShape::Vector(3)]).collect();
        let roots = parts.iter().flat_map(|(rows, _)| rows.iter().flatten()).chain(&tree.fixed);
        let roots: Vec<Id> = roots.copied().collect();
        self.style.write("motion_gradients", &Program::of(self.style.graph, &roots).fused(), &shapes)
    }
}

/// The structure of a tree, as a constant.
fn structure(tree: &BodyTree) -> TokenStream {
    let literal = Literal::usize_unsuffixed;
    let option = |index: Option<usize>| match index.map(literal) {
        Some(index) => quote!(::core::option::Option::Some(#index)),
        None => quote!(::core::option::Option::None),
    };
    let joints = tree.joints.iter().map(|&TreeJoint { before, turns, columns: [first, end], depth, .. }| {
        let before = option(before);
        quote! {
            __lagrange::generated::Joint { before: #before, turns: #turns, columns: [#first, #end], depth: #depth }
        }
    });
    let mut changing = 0..;
    let columns = tree.columns.iter().map(|column| {
        let (coordinate, own) = (column.coordinate, column.rates.and_then(|_| changing.next()));
        let own = option(own);
        quote!(__lagrange::generated::JointColumn { coordinate: #coordinate, changing: #own })
    });
    let bends = tree.bends.iter().map(|([a, b], _)| quote!([#a, #b]));
    let bodies = tree.bodies.iter().map(|body| literal(body.joint));
    quote! {
        __lagrange::generated::Tree {
            joints: &[#(#joints),*],
            columns: &[#(#columns),*],
            bodies: &[#(#bodies),*],
            bends: &[#(#bends),*],
        }
    }
}
