//! Limits how many queries may wait for their answers: each waiting query has a place, and each client has a fixed
//! number of places. So a client that asks faster than it reads takes no place from the Requests of other clients.

use std::collections::BTreeMap;
use std::sync::Arc;
use sun2xp::realtime::Mutex;
use sun2xp_remote_protocol::ClientName;

/// Largest number of Requests of one client that may wait.
const OF_CLIENT: usize = 8;

/// Largest number of queries for the Status that may wait, counted over all clients. The Zenoh key of the Status does
/// not contain the name of a client.
const OF_STATUS: usize = 64;

/// The number of waiting queries of each client. The entry without a name counts the queries for the Status.
type Counts = BTreeMap<Option<ClientName>, usize>;

/// The places of all waiting queries.
#[derive(Clone, Default)]
pub struct Places(Arc<Mutex<Counts>>);

/// A place. It becomes free when it is dropped.
pub struct Place {
    places: Places,
    of: Option<ClientName>,
}

impl Places {
    /// Returns a place for a Request of client `of`. If `of` is none, returns a place for a query for the Status.
    /// Returns none if all places are taken.
    #[must_use]
    pub fn take(&self, of: Option<ClientName>) -> Option<Place> {
        let most = if of.is_some() { OF_CLIENT } else { OF_STATUS };
        let mut counts = self.0.lock();
        let count = counts.get(&of).copied().unwrap_or(0);
        if count >= most {
            return None;
        }
        counts.insert(of.clone(), count + 1);
        drop(counts);
        Some(Place { places: self.clone(), of })
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let mut counts = self.places.0.lock();
        let left = counts.get(&self.of).map_or(0, |count| count.saturating_sub(1));
        if left == 0 {
            // A name without waiting queries has no entry.
            counts.remove(&self.of);
        } else {
            counts.insert(self.of.clone(), left);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_client_takes_no_place_of_another() {
        let places = Places::default();
        let client = |name: &str| -> Option<ClientName> { Some(name.parse().expect("a name")) };
        let mut taken: Vec<Place> = (0..OF_CLIENT).map(|_| places.take(client("alice")).expect("a place")).collect();
        assert!(places.take(client("alice")).is_none());
        assert!(places.take(client("bob")).is_some() && places.take(None).is_some());
        taken.pop();
        taken.push(places.take(client("alice")).expect("the place that became free"));
        assert!(places.take(client("alice")).is_none());
        drop(taken);
        assert!(places.0.lock().is_empty());
    }

    #[test]
    fn gets_of_the_status_have_places_of_their_own() {
        let places = Places::default();
        let taken: Vec<Place> = std::iter::from_fn(|| places.take(None)).take(OF_STATUS + 1).collect();
        assert_eq!(taken.len(), OF_STATUS);
    }
}
