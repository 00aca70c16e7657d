//! When each value is computed and where it is kept.

use std::collections::HashMap;

use rne_runtime::machine::{Code, Instruction, NOWHERE, Operation, Slot, Turn};

use crate::dataflow::{Dataflow, Definition, Value};
use crate::selection::{Place, constants, operation};

/// What happens, one after the other.
#[derive(Clone, Copy, Debug)]
enum Event {
    /// A value is computed, or an input or a constant is fetched, in the accumulator.
    Compute(Value),
    /// It is written while it is there.
    Output(usize),
    /// All sines and cosines.
    Turns,
}

/// The code of a program.
pub(crate) fn code(dataflow: &Dataflow) -> Option<Code> {
    let constant = |value: Value| match dataflow.values[value] {
        Definition::Constant(k) => Some(k),
        _ => None,
    };
    // constants that an instruction carries need no place
    let carried: Vec<Vec<Value>> = dataflow.values.iter().map(|definition| constants(definition, constant)).collect();
    let events = events(dataflow, &carried);
    allocated(dataflow, &carried, &events)
}

/// Values in the order of the program; what is fetched comes just before its first use, but not between a value and
/// the one that takes it from the accumulator.
fn events(dataflow: &Dataflow, carried: &[Vec<Value>]) -> Vec<Event> {
    let is_live = live(dataflow);
    let mut outputs: HashMap<Value, Vec<usize>> = HashMap::new();
    for (index, output) in dataflow.outputs.iter().enumerate() {
        outputs.entry(*output).or_default().push(index);
    }
    let is_fetched = |value: Value| matches!(dataflow.values[value], Definition::Input(_) | Definition::Constant(_));
    let mut fetched = vec![false; dataflow.values.len()];
    let mut events = Vec::new();
    let part = |range: std::ops::Range<Value>, last: &[Value], fetched: &mut Vec<bool>, events: &mut Vec<Event>| {
        let computed: Vec<Value> =
            range.filter(|value| is_live[*value] && dataflow.values[*value].is_computed()).collect();
        let mut chain = events.len();
        let mut before = None;
        for value in computed {
            let operands = dataflow.values[value].operands();
            if before.is_none_or(|before| !operands.contains(&before)) {
                chain = events.len();
            }
            for operand in operands {
                if is_fetched(operand) && !carried[value].contains(&operand) && !fetched[operand] {
                    fetched[operand] = true;
                    events.insert(chain, Event::Compute(operand));
                    chain += 1;
                }
            }
            events.push(Event::Compute(value));
            let written = outputs.get(&value).into_iter().flatten();
            events.extend(written.map(|index| Event::Output(*index)));
            before = Some(value);
        }
        for &value in last {
            if is_fetched(value) && !std::mem::replace(&mut fetched[value], true) {
                events.push(Event::Compute(value));
            }
        }
    };
    part(0..dataflow.before_turns, &dataflow.angles, &mut fetched, &mut events);
    events.push(Event::Turns);
    part(dataflow.before_turns..dataflow.values.len(), &[], &mut fetched, &mut events);
    // what is returned without being computed
    for (index, &output) in dataflow.outputs.iter().enumerate() {
        if !dataflow.values[output].is_computed() {
            events.push(Event::Compute(output));
            events.push(Event::Output(index));
        }
    }
    events
}

/// Which values the outputs depend on.
pub(crate) fn live(dataflow: &Dataflow) -> Vec<bool> {
    let mut is_live = vec![false; dataflow.values.len()];
    let mut open: Vec<Value> = dataflow.outputs.clone();
    while let Some(value) = open.pop() {
        if !std::mem::replace(&mut is_live[value], true) {
            open.extend(dataflow.values[value].operands());
            if let Definition::Sine(turn) | Definition::Cosine(turn) = dataflow.values[value] {
                open.push(dataflow.angles[turn]);
            }
        }
    }
    // all angles are turned
    open.extend(&dataflow.angles);
    while let Some(value) = open.pop() {
        if !std::mem::replace(&mut is_live[value], true) {
            open.extend(dataflow.values[value].operands());
        }
    }
    is_live
}

/// Gives every value that is not used at once a slot, for as long as it is used.
fn allocated(dataflow: &Dataflow, carried: &[Vec<Value>], events: &[Event]) -> Option<Code> {
    let count = dataflow.values.len();
    let (mut uses, mut last) = (vec![0_usize; count], vec![0_usize; count]);
    for (at, event) in events.iter().enumerate() {
        let used = match *event {
            Event::Compute(value) => match dataflow.values[value] {
                // returned as it is
                Definition::Sine(_) | Definition::Cosine(_) => vec![value],
                definition => {
                    definition.operands().into_iter().filter(|operand| !carried[value].contains(operand)).collect()
                }
            },
            Event::Output(..) => Vec::new(),
            Event::Turns => dataflow.angles.clone(),
        };
        for value in used {
            uses[value] += 1;
            last[value] = at;
        }
    }
    let is_sine = |value: Value| matches!(dataflow.values[value], Definition::Sine(_) | Definition::Cosine(_));
    let mut memory = Memory { slots: vec![None; count], free: Vec::new(), count: 0 };
    let (mut angles, mut rest, mut turns) = (Vec::new(), Vec::new(), Vec::new());
    let (mut accumulator, mut is_turned) = (None, false);
    for (at, event) in events.iter().enumerate() {
        let into = if is_turned { &mut rest } else { &mut angles };
        match *event {
            Event::Output(index) => {
                into.push(Instruction { operation: Operation::Output(u32::try_from(index).ok()?), store: NOWHERE });
            }
            Event::Turns => {
                let mut sines = HashMap::new();
                for value in (0..count).filter(|value| is_sine(*value) && uses[*value] > 0) {
                    sines.insert(value, memory.take(value)?);
                }
                let of = |wanted: Definition| {
                    sines
                        .iter()
                        .find(|(value, _)| dataflow.values[**value] == wanted)
                        .map_or(NOWHERE, |(_, slot)| *slot)
                };
                for (index, angle) in dataflow.angles.iter().enumerate() {
                    let (sine, cosine) = (of(Definition::Sine(index)), of(Definition::Cosine(index)));
                    turns.push(Turn { angle: memory.slots[*angle]?, sine, cosine });
                }
                memory.release(dataflow.angles.iter().copied().filter(|angle| last[*angle] == at));
                accumulator = None;
                is_turned = true;
            }
            Event::Compute(value) => {
                let definition = &dataflow.values[value];
                let place = |accumulator: Option<Value>, operand: Value| {
                    if let (Definition::Constant(k), true) =
                        (dataflow.values[operand], carried[value].contains(&operand))
                    {
                        return Place::Constant(k);
                    }
                    match memory.slots[operand] {
                        _ if accumulator == Some(operand) => Place::Accumulator,
                        Some(slot) => Place::Slot(slot),
                        None => Place::Slot(NOWHERE),
                    }
                };
                let operation = if is_sine(value) {
                    Operation::CopyS(memory.slots[value]?)
                } else {
                    operation(definition, |operand| place(accumulator, operand))
                        .or_else(|| operation(definition, |operand| place(None, operand)))?
                };
                let ended = definition.operands().into_iter().filter(|operand| last[*operand] == at);
                memory.release(ended);
                let is_taken = uses[value] == 1 && takes_from_accumulator(dataflow, carried, &events[at + 1..], value);
                let store =
                    if is_taken || uses[value] == 0 || is_sine(value) { NOWHERE } else { memory.take(value)? };
                into.push(Instruction { operation, store });
                accumulator = Some(value);
            }
        }
    }
    let slots = memory.count as usize;
    Code::new(angles, turns, rest, [slots, dataflow.inputs.len(), dataflow.outputs.len()])
}

/// Whether the next value is computed from this one where it is, in the accumulator.
fn takes_from_accumulator(dataflow: &Dataflow, carried: &[Vec<Value>], events: &[Event], value: Value) -> bool {
    let next = events.iter().find(|event| !matches!(event, Event::Output(..)));
    let Some(Event::Compute(next)) = next else { return false };
    let definition = &dataflow.values[*next];
    definition.operands().contains(&value)
        && operation(definition, |operand| match dataflow.values[operand] {
            _ if operand == value => Place::Accumulator,
            Definition::Constant(k) if carried[*next].contains(&operand) => Place::Constant(k),
            _ => Place::Slot(0),
        })
        .is_some()
}

struct Memory {
    slots: Vec<Option<Slot>>,
    free: Vec<Slot>,
    count: Slot,
}

impl Memory {
    /// A slot for a value: the one that was freed last, for it is in the cache.
    fn take(&mut self, value: Value) -> Option<Slot> {
        let slot = if let Some(slot) = self.free.pop() {
            slot
        } else {
            self.count = self.count.checked_add(1).filter(|count| *count < NOWHERE)?;
            self.count - 1
        };
        self.slots[value] = Some(slot);
        Some(slot)
    }

    fn release(&mut self, values: impl Iterator<Item = Value>) {
        for value in values {
            self.free.extend(self.slots[value].take());
        }
    }
}
