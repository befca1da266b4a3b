//! What figures with equal parameters share.
//!
//! Making a figure is a pure function of its parameters, so sharing shows in time and memory alone. Nothing is kept once
//! the last who shows it is gone.

use crate::describe::{Describe, FieldVisitor, Spec, Value};
use core::any::{Any, TypeId};
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, PoisonError, Weak},
};

/// A type of figure and its parameters.
type Key = (TypeId, Vec<u64>);

/// What was made and is still in use.
static MADE: Mutex<BTreeMap<Key, Weak<dyn Any + Send + Sync>>> = Mutex::new(BTreeMap::new());

/// What `make` makes of a figure, or what was made of an equal one.
///
/// # Errors
/// Those of `make`.
pub(super) fn shared<F: Describe + Clone + 'static, T: Any + Send + Sync, E>(
    figure: &F,
    make: impl FnOnce() -> Result<T, E>,
) -> Result<Arc<T>, E> {
    let Some(parameters) = parameters(figure) else { return make().map(Arc::new) };
    let key = (TypeId::of::<F>(), parameters);
    let known = || MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let found = known().get(&key).and_then(Weak::upgrade).and_then(|made| made.downcast().ok());
    if let Some(made) = found {
        return Ok(made);
    }
    // Not under the lock: large figures take a while.
    let made = Arc::new(make()?);
    let mut known = known();
    known.retain(|_, made| made.strong_count() > 0);
    let as_any: Arc<dyn Any + Send + Sync> = made.clone();
    known.insert(key, Arc::downgrade(&as_any));
    Ok(made)
}

/// The parameters of a figure, bit by bit; none if some are files.
fn parameters<F: Describe + Clone>(figure: &F) -> Option<Vec<u64>> {
    let mut bits = Bits(Some(vec![]));
    figure.clone().describe(&mut bits);
    bits.0
}

/// Gathers the values of all fields.
struct Bits(Option<Vec<u64>>);

impl FieldVisitor for Bits {
    fn field(&mut self, _: &'static str, value: Value<'_>, _: Spec) {
        let Some(bits) = &mut self.0 else { return };
        let mut add = |numbers: &[f64]| bits.extend(numbers.iter().map(|number| number.to_bits()));
        match value {
            Value::Number(number) => add(&[*number]),
            Value::Vector(vector) | Value::Color(vector) => add(&vector.to_array()),
            // No sum of finite numbers is NaN, so it stands for what is absent.
            Value::OptionalNumber(number) => add(&[number.unwrap_or(f64::NAN)]),
            Value::OptionalVector(vector) => add(&vector.map_or([f64::NAN; 3], |vector| vector.to_array())),
            Value::Integer(number) => add(&[f64::from(*number)]),
            Value::Bool(is) => add(&[f64::from(u8::from(*is))]),
            Value::Choice(choice) => add(&[choice.position() as f64]),
            Value::Vectors(list) => {
                add(&[list.len() as f64]);
                list.iter().for_each(|vector| add(&vector.to_array()));
            }
            Value::Vectors2(list) => {
                add(&[list.len() as f64]);
                list.iter().for_each(|vector| add(&vector.to_array()));
            }
            Value::Steps(_) | Value::Model(_) | Value::Image(_) => self.0 = None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Lathe;
    use glam::DVec2;

    fn cone(radius: f64) -> Lathe {
        Lathe { profile: vec![DVec2::ZERO, DVec2::X * radius, DVec2::Y], ..Lathe::default() }
    }

    #[test]
    fn equal_figures_share_and_others_do_not() {
        let made = |radius, number| shared(&cone(radius), || Ok::<_, ()>(number)).expect("made");
        let (first, second) = (made(0.271, 1), made(0.271, 2));
        assert!(Arc::ptr_eq(&first, &second) && *second == 1);
        assert_eq!(*made(0.2718, 3), 3);
        drop((first, second));
        assert_eq!(*made(0.271, 4), 4, "nothing is kept that nobody shows");
    }

    #[test]
    fn every_field_tells_figures_apart() {
        let all = [
            cone(1.0),
            cone(2.0),
            Lathe { segments: 7, ..cone(1.0) },
            Lathe { shading: crate::shape::Shading::Flat, ..cone(1.0) },
            Lathe { profile: vec![DVec2::ZERO, DVec2::X], ..cone(1.0) },
        ];
        let keys: std::collections::BTreeSet<_> = all.iter().map(|lathe| parameters(lathe).expect("bits")).collect();
        assert_eq!(keys.len(), all.len());
    }
}
