//! Who owns the hand: at most one client. Each successful acquire begins an epoch, which is named by a secret random
//! number. Targets, and all Requests except acquire and stop, are accepted only with the epoch in force
//! (docs/remote-protocol.md).

use sun2xp_remote_protocol::ClientName;

/// The owner of the hand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Owner {
    /// The client.
    pub client: ClientName,
    /// The epoch: a random number that is not 0. Of the clients, only the owner knows it.
    pub epoch: u64,
    /// The public number of the epoch. Later epochs have higher numbers.
    pub number: u64,
}

/// The ownership of a hand.
#[derive(Debug)]
pub struct Ownership {
    owner: Option<Owner>,
    /// The number of the newest epoch.
    newest: u64,
}

impl Ownership {
    /// A hand without an owner. `start` is the time at which the server has started, by CLOCK_MONOTONIC, ns. The
    /// numbers of epochs begin above `start`, so they are higher than the numbers of an earlier server, unless the
    /// machine was restarted in between.
    #[must_use]
    pub fn new(start: u64) -> Self {
        Self { owner: None, newest: start }
    }

    /// Returns the owner; none if nobody owns the hand.
    #[must_use]
    pub fn owner(&self) -> Option<&Owner> {
        self.owner.as_ref()
    }

    /// Returns the number of the epoch in force; 0 if nobody owns the hand.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.owner.as_ref().map_or(0, |owner| owner.number)
    }

    /// Returns whether this client owns the hand and `epoch` is the epoch in force.
    #[must_use]
    pub fn admits(&self, client: &ClientName, epoch: u64) -> bool {
        self.owner.as_ref().is_some_and(|owner| owner.client == *client && owner.epoch == epoch)
    }

    /// Returns the owner because of whom an acquire by this client is refused; none if the acquire is admitted.
    #[must_use]
    pub fn other_owner(&self, client: &ClientName, take_over: bool) -> Option<&Owner> {
        self.owner.as_ref().filter(|owner| owner.client != *client && !take_over)
    }

    /// Makes this client the owner, with this epoch. The previous epoch ends. If another client owns the hand, the call
    /// is refused unless `take_over` is set.
    ///
    /// # Errors
    /// Returns the name of the other owner. Then nothing has changed.
    pub fn acquire(&mut self, client: &ClientName, take_over: bool, epoch: u64) -> Result<&Owner, ClientName> {
        if let Some(other) = self.other_owner(client, take_over) {
            return Err(other.client.clone());
        }
        self.newest += 1;
        Ok(self.owner.insert(Owner { client: client.clone(), epoch, number: self.newest }))
    }

    /// Ends the ownership. Returns the previous owner, if there was one.
    pub fn end(&mut self) -> Option<Owner> {
        self.owner.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(text: &str) -> ClientName {
        text.parse().expect("a name")
    }

    #[test]
    fn one_client_owns_the_hand_and_a_take_over_ends_its_epoch() {
        let (alice, bob) = (name("alice"), name("bob"));
        let mut ownership = Ownership::new(40);
        assert!(!ownership.admits(&alice, 0) && ownership.number() == 0);
        assert_eq!(ownership.acquire(&alice, false, 7).expect("free").number, 41);
        assert!(ownership.admits(&alice, 7) && !ownership.admits(&alice, 8) && !ownership.admits(&bob, 7));
        assert_eq!(ownership.acquire(&bob, false, 8), Err(alice.clone()));
        assert!(ownership.admits(&alice, 7), "a refusal changes nothing");
        assert_eq!(ownership.acquire(&bob, true, 8).expect("taken over").number, 42);
        assert!(!ownership.admits(&alice, 7) && ownership.admits(&bob, 8));
    }

    #[test]
    fn an_owner_that_acquires_again_ends_its_earlier_epoch() {
        let alice = name("alice");
        let mut ownership = Ownership::new(40);
        ownership.acquire(&alice, false, 7).expect("free");
        assert_eq!(ownership.acquire(&alice, false, 9).expect("its own").number, 42);
        assert!(!ownership.admits(&alice, 7) && ownership.admits(&alice, 9));
        assert_eq!(ownership.end().map(|owner| owner.epoch), Some(9));
        assert!(!ownership.admits(&alice, 9) && ownership.number() == 0);
        assert_eq!(ownership.acquire(&alice, false, 3).expect("free").number, 43, "numbers are not used again");
    }
}
