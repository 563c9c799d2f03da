//! Parsers of constraints: equations, contacts and dry friction.

use proc_macro2::Delimiter;
use syn::Result;

use super::cursor::Cursor;
use super::declaration::{Constraint, ImpactLaw, Law};
use super::expression::{self, Expression, Kind};
use super::forms::{colon, equals, finish, form};
use super::name::Name;
use super::slips;
use super::target::{Target, target};
use super::unread::unread;
use crate::symbolic::Rational;

/// What is read after the name of a constraint: its sides, and the field that switches it.
struct Stated {
    sides: (Expression, Expression),
    when: Option<Name>,
    law: Law,
}

/// Reads a constraint.
pub(super) fn constraint(cursor: &mut Cursor, constraints: &mut Vec<Constraint>) -> Result<()> {
    let unread = |_| Law::Equation;
    stated(cursor, ("constraint", unread), constraints, |cursor, _| {
        let sides = sides(&mut cursor.until_comma())?;
        let when = when(cursor)?;
        finish(cursor, "constraint")?;
        Ok(vec![Stated { sides, when, law: Law::Equation }])
    })
}

/// Reads a contact, with its friction as a constraint of its own.
pub(super) fn contact(cursor: &mut Cursor, constraints: &mut Vec<Constraint>) -> Result<()> {
    let unread = |_| Law::Contact { restitution: None, impact: ImpactLaw::default() };
    stated(cursor, ("contact", unread), constraints, |cursor, name| {
        let sides = gap(&mut cursor.until_comma())?;
        let (mut restitution, mut impact, mut friction) = (None, ImpactLaw::default(), None);
        while !cursor.is_empty() {
            if cursor.take_word("restitution") {
                once(cursor, restitution.is_some(), "the restitution of this contact")?;
                impact = impact_law(cursor)?;
                cursor.expect_punct(':', "expected `:` after `restitution`, as in `restitution: 0.8`")?;
                restitution = Some(expression::whole(&mut cursor.until_comma())?);
            } else if cursor.take_word("friction") {
                once(cursor, friction.is_some(), "the friction of this contact")?;
                friction = Some(coulomb(cursor)?);
            } else {
                let message = "a contact has `restitution: e` and `friction(mu): velocity` after its gap";
                return Err(cursor.error(slips::meant(cursor, &["restitution", "friction"], message)));
            }
        }
        let when = Some(name.clone());
        let gap = Stated { sides, when: when.clone(), law: Law::Contact { restitution, impact } };
        let friction = friction.map(|(sides, law)| Stated { sides, when, law });
        Ok([gap].into_iter().chain(friction).collect())
    })
}

/// Reads `(poisson)`, the law of impact, if it is given.
fn impact_law(cursor: &mut Cursor) -> Result<ImpactLaw> {
    let Some(group) = cursor.take_group(Delimiter::Parenthesis) else { return Ok(ImpactLaw::default()) };
    let mut inside = Cursor::inside(&group);
    let laws = [("newton", ImpactLaw::Newton), ("poisson", ImpactLaw::Poisson)];
    match laws.into_iter().find(|(word, _)| inside.take_word(word)) {
        Some((_, law)) if inside.is_empty() => Ok(law),
        _ => Err(inside.error(
            "the law of an impact is `newton` or `poisson`: write `restitution(poisson): e`, or `restitution: e` for Newton's law",
        )),
    }
}

/// Reads dry friction.
pub(super) fn friction(cursor: &mut Cursor, constraints: &mut Vec<Constraint>) -> Result<()> {
    let unread = |sliding| Law::Dry { limit: None, sliding };
    stated(cursor, ("friction", unread), constraints, |cursor, name| {
        let sides = against_zero(expression::whole(&mut cursor.until_comma())?);
        let (mut limit, mut sliding) = (None, None);
        while !cursor.is_empty() {
            let [is_limit, is_sliding] = ["limit", "sliding"].map(|word| cursor.take_word(word));
            if !is_limit && !is_sliding {
                let message = "friction has `limit: bound` and `sliding: force` after its velocity";
                return Err(cursor.error(message));
            }
            let bound = if is_limit { &mut limit } else { &mut sliding };
            once(cursor, bound.is_some(), "this bound of the friction")?;
            cursor.expect_punct(':', "expected `:` after this, as in `limit: 3*m, sliding: 2*m`")?;
            *bound = Some(expression::whole(&mut cursor.until_comma())?);
        }
        let Some(sliding) = sliding else {
            return Err(
                cursor.error(format!("the force of sliding is missing: write `{}`", form("friction")))
            );
        };
        Ok(vec![Stated { sides, when: Some(name.clone()), law: Law::Dry { limit, sliding } }])
    })
}

/// Reads a name and what `read` makes of the rest. After an error, still adds a constraint of the same name and number and of
/// a law, so that later stages know the count.
fn stated(
    cursor: &mut Cursor,
    (word, law): (&str, impl FnOnce(Expression) -> Law),
    constraints: &mut Vec<Constraint>,
    read: impl FnOnce(&mut Cursor, &Name) -> Result<Vec<Stated>>,
) -> Result<()> {
    let written = cursor.clone();
    let target = target_before_colon(cursor, word);
    let all = target.clone().and_then(|target| {
        colon(cursor, word)?;
        read(cursor, &target.name)
    });
    let target = target.unwrap_or(Target::whole(Name { text: String::new(), place: written.place() }));
    let is_switched = word != "constraint";
    let (all, result) = match all {
        Ok(all) => (all, Ok(())),
        Err(error) => {
            let (left, when) = (unread(written), is_switched.then(|| target.name.clone()));
            (vec![Stated { sides: (left.clone(), left.clone()), when, law: law(left) }], Err(error))
        }
    };
    for Stated { sides: (left, right), when, law } in all {
        let mut target = target.clone();
        if matches!(law, Law::Coulomb { .. }) {
            target.name.text += "_friction";
        }
        constraints.push(Constraint { target, left, right, is_implied: false, when, law });
    }
    result
}

/// Fails if this part of a contact or of friction is given twice.
fn once(cursor: &Cursor, is_known: bool, what: &str) -> Result<()> {
    if is_known { Err(cursor.last_place().error(format!("{what} is given twice"))) } else { Ok(()) }
}

/// Reads `(mu): velocity` or `(static: mu, kinetic: nu): velocity`.
fn coulomb(cursor: &mut Cursor) -> Result<((Expression, Expression), Law)> {
    const FORM: &str =
        "the friction of a contact has a coefficient and a velocity: write `friction(mu): x_dot`";
    let Some(group) = cursor.take_group(Delimiter::Parenthesis) else { return Err(cursor.error(FORM)) };
    let (limit, sliding) = coefficients(&mut Cursor::inside(&group))?;
    cursor.expect_punct(':', FORM)?;
    let velocity = expression::whole(&mut cursor.until_comma())?;
    Ok((against_zero(velocity), Law::Coulomb { limit, sliding }))
}

/// Reads `mu`, or `static: mu, kinetic: nu`.
fn coefficients(inside: &mut Cursor) -> Result<(Option<Expression>, Expression)> {
    const FORM: &str = "the friction of a contact has one coefficient, or one at rest and one of sliding: write `friction(mu): x_dot` or `friction(static: mu, kinetic: nu): x_dot`";
    let words = ["static", "kinetic"];
    let is_given = |word: &&str| {
        let mut ahead = inside.clone();
        ahead.take_word(word) && ahead.is_punct(':')
    };
    let Some(first) = words.iter().position(is_given) else {
        let mut ahead = inside.clone();
        if ahead.take_ident().is_some() && (ahead.is_punct(':') || ahead.is_punct('=')) {
            return Err(inside.error(slips::meant(inside, &words, FORM)));
        }
        let sliding = expression::whole(&mut inside.until_comma())?;
        return if inside.is_empty() { Ok((None, sliding)) } else { Err(inside.error(FORM)) };
    };
    inside.take_word(words[first]);
    inside.expect_punct(':', FORM)?;
    let one = expression::whole(&mut inside.until_comma())?;
    if !inside.take_word(words[1 - first]) {
        return Err(inside.error(FORM));
    }
    inside.expect_punct(':', FORM)?;
    let other = expression::whole(&mut inside.until_comma())?;
    if !inside.is_empty() {
        return Err(inside.error(FORM));
    }
    let (limit, sliding) = if first == 0 { (one, other) } else { (other, one) };
    Ok((Some(limit), sliding))
}

/// The sides of velocity = 0.
fn against_zero(velocity: Expression) -> (Expression, Expression) {
    let zero = Kind::Number(Rational::from_integer(0).into());
    let right = Expression { kind: zero, place: velocity.place };
    (velocity, right)
}

/// Reads `left >= right`.
fn gap(inequality: &mut Cursor) -> Result<(Expression, Expression)> {
    let mut left = inequality.until(|cursor| cursor.is_pair('>', '='));
    if inequality.is_empty() {
        let message = format!("the gap of a contact is at least zero: write `{}`", form("contact"));
        return Err(left
            .find(|cursor| ['<', '>', '='].iter().any(|&sign| cursor.is_punct(sign)))
            .error(message));
    }
    let left = expression::whole(&mut left)?;
    inequality.skip(2);
    Ok((left, expression::whole(inequality)?))
}

/// Reads `when: field` after a constraint.
fn when(cursor: &mut Cursor) -> Result<Option<Name>> {
    if !cursor.take_word("when") {
        return Ok(None);
    }
    cursor.expect_punct(':', "expected `:` after `when`, as in `when: held`")?;
    let field = cursor.name("the name of a field of type `bool`")?;
    cursor.take_punct(',');
    let message = "`when` takes the name of a field of type `bool`, as in `when: held`, and no condition: a constraint on one side is a contact, `#[contact(name: gap >= 0)]`";
    if cursor.is_empty() { Ok(Some(field)) } else { Err(field.place.error(message)) }
}

/// Reads the name of a constraint, a contact or friction.
fn target_before_colon(cursor: &mut Cursor, word: &str) -> Result<Target> {
    let start = cursor.place();
    match target(cursor, &format!("the name of the {word}")) {
        Ok(target) if cursor.is_punct(':') => Ok(target),
        // Point the error at the start: without a name, the equation begins there.
        _ => {
            let message = format!("a {word} begins with a name of one word: write `{}`", form(word));
            Err(start.error(message))
        }
    }
}

/// Reads `left = right` with exactly one `=`.
fn sides(equation: &mut Cursor) -> Result<(Expression, Expression)> {
    let mut left = equation.until_equals();
    let left = expression::whole(&mut left)?;
    equals(equation, "constraint")?;
    let mut rest = equation.until_equals();
    let right = expression::whole(&mut rest)?;
    if !equation.is_empty() {
        return Err(equation.error("a constraint has one `=`: write two constraints"));
    }
    Ok((left, right))
}
