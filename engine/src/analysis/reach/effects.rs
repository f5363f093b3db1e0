//! The effects of collisions on the positions and orientations of sprites.

use super::cells::{Cells, Directions};
use super::events::Events;
use super::meetings::{Meeting, Order};
use super::mobility::pushes_straight;
use crate::rules::SpriteType;
use crate::rules::effects::{Displacement, EffectSummary, Spot, Summary, Turn};

impl Events<'_> {
    /// Applies an effect to sprite positions. `cells` contains the cells of the collision.
    pub(super) fn run(&mut self, meeting: &Meeting<'_>, one: SpriteType, cells: &Cells) {
        let at = meeting.order;
        let summary = meeting.summary(self.flood.model.rules);
        let own = self.near(one, cells);
        self.turn_to(one, cells, summary);
        if !summary.needs_partner && self.run_on_one(at, one, (cells, &own), summary) {
            return;
        }
        // Timed effects and effects at the edge have no partner, without which most effects do nothing.
        if let Some(two) = meeting.two() {
            self.run_on_both(at, (one, two), (cells, &own), summary);
        }
    }

    /// Applies an effect that needs no partner. Returns `false` if the effect does not affect positions.
    fn run_on_one(
        &mut self,
        at: Order,
        one: SpriteType,
        (cells, own): (&Cells, &Cells),
        summary: &Summary,
    ) -> bool {
        let mut any = true;
        match summary.displacement {
            Some(Displacement::BackAndDown) => self.turn_around(one, cells, at),
            Some(Displacement::OppositeEdge { offset }) => self.wrap(one, own, offset, at),
            Some(
                Displacement::Back
                | Displacement::Flush
                | Displacement::Stop
                | Displacement::Apart
                | Displacement::OntoPartner
                | Displacement::InLine
                | Displacement::Pushed
                | Displacement::Carried { .. }
                | Displacement::Exit,
            )
            | None => any = false,
        }
        if summary.spot == Some(Spot::AtFirst) {
            summary.spawns().for_each(|stype| self.spawn_in(stype, own, at));
            any = true;
        }
        if summary.effects.contains(&EffectSummary::Clone) {
            self.spawn_in(one, own, at);
            any = true;
        }
        for to in summary.becomes() {
            self.turn(one, to, cells, at);
            any = true;
        }
        if let Some((from, to)) = summary.becomes_all() {
            self.become_all(from, to, at);
            any = true;
        }
        any
    }

    /// Applies an effect to two colliding sprites.
    fn run_on_both(
        &mut self,
        at: Order,
        (one, two): (SpriteType, SpriteType),
        (cells, own): (&Cells, &Cells),
        summary: &Summary,
    ) {
        let model = self.flood.model;
        let partner = self.near(two, cells);
        if let Some((from, to)) = summary.becomes_all() {
            self.become_all(from, to, at);
        }
        for to in summary.becomes() {
            self.turn(one, to, cells, at);
        }
        let from = match summary.spot {
            Some(Spot::Beside { shift, of_last_place: false }) => self.board().beside(&partner, shift),
            Some(Spot::Beside { shift, of_last_place: true }) => self.board().beside(self.touch(two), shift),
            Some(Spot::Behind) => self.touch(two).clone(),
            Some(Spot::AtFirst) => own.clone(),
            None => Cells::default(),
        };
        if summary.spot.is_some() {
            summary.spawns().for_each(|stype| self.spawn_in(stype, &from, at));
        }
        match summary.displacement {
            Some(Displacement::Flush | Displacement::Stop) => {
                // A sprite placed flush with a moving sprite, or with a sprite that it was inside, may stand
                // where its own movement would not have taken it.
                let inside = !cells.shared(self.rest(one)).is_empty();
                if inside || !model.stops_in_order(one, two) {
                    let flush = self.board().around(cells, 2 * model.rules.reach.max(1));
                    self.come_to(one, &flush, at);
                }
            }
            Some(Displacement::OntoPartner) => {
                let more = if model.scales { model.spread(one) } else { 0 };
                let targets = self.board().around(&partner, more);
                self.come_to(one, &targets, at);
            }
            Some(Displacement::InLine) => {
                let targets = self.board().around(cells, 1 + model.rules.reach.max(1));
                self.come_to(one, &targets, at);
            }
            Some(Displacement::Pushed) => self.push((one, two), own, at),
            Some(Displacement::Carried { onto }) => {
                self.pull((one, two), own, at);
                if onto {
                    self.come_to(one, &partner, at);
                }
            }
            Some(Displacement::Exit) => {
                for &exit in model.exits[two.index()].iter().filter(|exit| model.exists[exit.index()]) {
                    let targets = self.touch(exit).clone();
                    self.come_to(one, &targets, at);
                }
            }
            // A sprite that goes back was at that position before.
            Some(
                Displacement::Back
                | Displacement::Apart
                | Displacement::BackAndDown
                | Displacement::OppositeEdge { .. },
            )
            | None => {}
        }
    }

    /// Turns all sprites of a type into sprites of a different type.
    pub(super) fn become_all(&mut self, from: SpriteType, to: SpriteType, at: Order) {
        if self.can_occur(from) {
            let all = Cells::all(self.board());
            self.turn(from, to, &all, at);
        }
    }

    /// Turns colliding sprites in the given cells into sprites of a different type.
    fn turn(&mut self, from: SpriteType, to: SpriteType, cells: &Cells, at: Order) {
        let model = self.flood.model;
        if !model.exists[to.index()] {
            return;
        }
        let here = self.near(from, cells);
        let heading = model.of_type(to).facing;
        self.appear_in(to, &here, at, heading);
        if model.of_type(to).goes_back {
            // At any later point in the tick, the new sprite can be moved back to the position that the old
            // sprite, or its predecessor, had before it moved.
            let before = self.rest(from).clone();
            self.appear_in(to, &before, Order::LAST, heading);
        }
    }

    /// Applies an effect to the directions of the affected sprites in the given cells.
    fn turn_to(&mut self, one: SpriteType, cells: &Cells, summary: &Summary) {
        let model = self.flood.model;
        let own = *model.of_type(one);
        let rotates = model.info(one).traits.rotate_in_place;
        let reverses = summary.turn == Some(Turn::Back)
            && !(rotates && summary.displacement == Some(Displacement::BackAndDown));
        let turn = |heading: Directions| if reverses { heading.mirrored() } else { own.facing };
        let turns = summary.turn.is_some() || summary.displacement == Some(Displacement::OntoPartner);
        if !turns || !own.is_steady() {
            return;
        }
        // By the end of the tick, the sprite may be back at its previous position, or at any position to
        // which something has moved it.
        let far = own.stride.max(model.pushed_far(one)).saturating_add(model.spread(one));
        let far = if own.placed || own.moved_any_distance {
            self.board().side() + 2
        } else {
            far.min(self.board().side() + 2)
        };
        let around = self.board().around(cells, far);
        self.flood.face(one, &around, turn);
    }

    /// Moves sprites back to their previous position and then two steps down.
    fn turn_around(&mut self, one: SpriteType, cells: &Cells, at: Order) {
        let model = self.flood.model;
        let (own, traits) = (*model.of_type(one), &model.info(one).traits);
        if traits.stationary || traits.continuous {
            return;
        }
        let board = self.board();
        let far = if own.boundless || own.moved_any_distance {
            board.side() + 2
        } else {
            own.stride.saturating_add(1 + model.spread(one))
        };
        let from = board.around(cells, far.saturating_add(model.pushed_far(one))).shared(self.rest(one));
        // The sprite takes two steps of one cell each. If a step can be a mere turn, the sprite can move by
        // fewer cells.
        let exact = !own.off_grid && own.top <= 1.0 && !traits.rotate_in_place;
        let most = 2 * model.stride(own.top.max(1.0)).0;
        // A negative speed moves the sprite up.
        let signs: &[i32] = if own.backwards { &[1, -1] } else { &[1] };
        for cell in from.iter() {
            // A sprite that starts further outside the board ends up less far inside it.
            let least = if exact && !board.is_ring(cell) { 2 } else { 1 };
            for (&sign, times) in signs.iter().flat_map(|sign| (least..=most).map(move |times| (sign, times)))
            {
                let to = board.shifted(cell, (0, sign), times);
                self.flood.come(one, to, at, own.facing);
            }
        }
    }

    /// Moves sprites to the opposite edge, along their orientation.
    fn wrap(&mut self, one: SpriteType, from: &Cells, offset: f64, at: Order) {
        let board = self.board();
        let facing = self.flood.model.of_type(one).facing;
        let facing = if facing.meets(Directions::ASKEW) { Directions::ANY } else { facing };
        let size =
            if self.flood.model.of_type(one).off_grid { self.flood.model.rules.reach.max(1) } else { 0 };
        for cell in from.iter() {
            let (x, y) = board.place(cell);
            let mut to: Vec<(i32, i32)> = Vec::new();
            let near = if offset == 0.0 { 0..=size } else { -1..=board.side() };
            for inset in near {
                for (way, place) in [
                    (Directions::RIGHT, (inset, y)),
                    (Directions::LEFT, (board.columns - 1 - inset, y)),
                    (Directions::DOWN, (x, inset)),
                    (Directions::UP, (x, board.rows - 1 - inset)),
                ] {
                    to.extend(facing.meets(way).then_some(place));
                }
            }
            to.into_iter().for_each(|(x, y)| self.flood.come(one, board.at(x, y), at, facing));
        }
    }

    /// Pushes sprites in cells that another sprite enters.
    fn push(&mut self, (one, two): (SpriteType, SpriteType), own: &Cells, at: Order) {
        let model = self.flood.model;
        let (box_, pusher) = (*model.of_type(one), *model.of_type(two));
        let traits = &model.info(one).traits;
        if traits.stationary || traits.continuous {
            return;
        }
        let board = self.board();
        let distance = model.carried(one, two);
        let (stride, leap) = model.stride(distance);
        let exact = pushes_straight(&pusher) && !pusher.backwards && !pusher.off_grid && !box_.off_grid;
        let exact = exact && !pusher.boundless && !box_.placed;
        let from = if box_.placed { own.clone() } else { own.shared(self.rest(one)) };
        let facing = box_.facing;
        let steps: Vec<(i32, i32)> = model.pushed(&pusher).steps().collect();
        let run_up = pusher.stride.max(model.pushed_far(two)).max(1);
        for cell in from.iter() {
            for &step in &steps {
                self.flood.work += u64::from(run_up.unsigned_abs());
                let behind = |times: i32| self.rest(two).contains(board.shifted(cell, step, -times));
                if !exact || (1..=run_up).any(behind) {
                    self.flood.go(one, cell, step, (stride, leap), (at, facing));
                }
            }
        }
    }

    /// Moves sprites along with another sprite at their position.
    fn pull(&mut self, (one, two): (SpriteType, SpriteType), own: &Cells, at: Order) {
        let model = self.flood.model;
        let (passenger, carrier) = (*model.of_type(one), *model.of_type(two));
        let traits = &model.info(one).traits;
        let distance = if traits.continuous { carrier.top * 10.0 / model.block } else { carrier.top };
        let (stride, leap) = model.stride(distance.max(passenger.top / model.block));
        let from = if passenger.placed { own.clone() } else { own.shared(self.rest(one)) };
        if traits.off_grid || carrier.moved.meets(Directions::ASKEW) || carrier.backwards {
            // The passenger may also be placed on top of the carrier.
            let more = stride.saturating_add(1 + model.rules.reach.max(1)).min(self.board().side() + 2);
            let targets = self.board().around(&from, more);
            return self.come_to(one, &targets, at);
        }
        let facing = passenger.facing;
        let steps: Vec<(i32, i32)> = carrier.moved.steps().collect();
        for cell in from.iter() {
            for &step in &steps {
                self.flood.go(one, cell, step, (stride, leap), (at, facing));
            }
        }
    }
}
