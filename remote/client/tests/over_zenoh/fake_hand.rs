//! The hand behind the small server of `server.rs`: its owner, and what its fingers do.

use std::sync::LazyLock;
use std::time::{Duration, Instant};
use sun2xp_remote_client::{ClientName, Counts, Event, Finger, FingerStatus, Record, Stage, Status};
use sun2xp_remote_protocol::{Action, Answer, Code, FaultText, Place, Request, State, Target};
use zenoh::Session;

/// Zero of the machine's clock. A server that is started again does not set this clock back.
static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);

pub struct FakeHand {
    /// Every Target of the owner, in the order of reception.
    pub targets: Vec<Target>,
    /// Every Request.
    pub requests: Vec<Request>,
    pub owner: Option<ClientName>,
    epoch: u64,
    epochs: u64,
    commands: [u32; 2],
    pub joints: [[f64; 3]; 2],
    pub stage: Stage,
    /// The text with which the next Target that has parts is refused.
    pub refuse: Option<String>,
    /// The events to publish, the last one first.
    pub events: Vec<Event>,
    /// Number of Requests that get no answer, as if they had reached nobody.
    pub unanswered: usize,
    /// The time after which a Request without an answer ends.
    pub unanswered_after: Duration,
    /// Number of gets of the Status that get no reply.
    pub unanswered_status: usize,
    /// The version byte of the hand's Status.
    pub version: u8,
    /// Number of States that are withheld after a recovery. Meanwhile the newest State that the clients have is from
    /// before the recovery.
    pub late_states: usize,
    /// Whether the server publishes nothing.
    pub silent: bool,
    pub ended: bool,
    pub session: Option<Session>,
    cycle: u64,
}

impl FakeHand {
    pub fn new() -> Self {
        Self {
            targets: Vec::new(),
            requests: Vec::new(),
            owner: None,
            epoch: 0,
            epochs: BEGIN.elapsed().as_nanos() as u64,
            commands: [0; 2],
            joints: [[0.25; 3]; 2],
            stage: Stage::Running,
            refuse: None,
            events: Vec::new(),
            unanswered: 0,
            unanswered_after: Duration::ZERO,
            unanswered_status: 0,
            version: 1,
            late_states: 0,
            silent: false,
            ended: false,
            session: None,
            cycle: 0,
        }
    }

    fn now(&self) -> u64 {
        1 + BEGIN.elapsed().as_nanos() as u64
    }

    /// Takes a Target of the epoch in force. If the Target is refused, returns the refusal.
    pub fn take(&mut self, target: Target) -> Option<Answer> {
        if self.owner.is_none() || target.epoch != self.epoch {
            return None;
        }
        let number = target.sequence;
        let refused = if target.parts.is_empty() { None } else { self.refuse.take() };
        if refused.is_none() {
            for part in target.parts.iter().filter(|part| part.finger.index() < 2) {
                let index = part.finger.index();
                if self.commands[index] == part.command {
                    continue;
                }
                self.commands[index] = part.command;
                if let Place::Joints(joints) = part.place {
                    self.joints[index] = joints;
                }
            }
        }
        self.targets.push(target);
        refused.map(|text| Answer { number, ..self.answered(Code::Argument, &text) })
    }

    fn answered(&self, code: Code, text: &str) -> Answer {
        Answer { code, catch_ms: 100, epoch: self.epoch, time: self.now(), number: 0, text: text.into() }
    }

    /// Answers a Request.
    pub fn answer(&mut self, client: &ClientName, payload: &[u8]) -> Vec<u8> {
        let request = Request::decode(payload).expect("a good Request");
        self.requests.push(request);
        let owns = self.owner.as_ref() == Some(client) && request.epoch == self.epoch;
        let answer = match (request.action, &self.owner) {
            (Action::Acquire, Some(owner)) if owner != client && !request.take_over => {
                self.answered(Code::Owned, &format!("{owner} owns the hand: release it there, or take it over"))
            }
            (Action::Acquire, _) => self.acquire(client, request.recover),
            (Action::Stop, _) => {
                self.stage = Stage::Faulted(23);
                self.answered(Code::Done, "")
            }
            _ if !owns => self.answered(Code::NotOwner, "the epoch is old: acquire the hand"),
            (Action::Release, _) => {
                self.owner = None;
                self.answered(Code::Done, "")
            }
            (Action::Recover, _) => {
                self.stage = Stage::Running;
                self.answered(Code::Done, "")
            }
            (Action::Calibrate | Action::Identify, _) => {
                self.answered(Code::InProgress, "finger 2 is being calibrated: wait until this is done")
            }
        };
        answer.encode().expect("a good Answer")
    }

    fn acquire(&mut self, client: &ClientName, recover: bool) -> Answer {
        self.owner = Some(client.clone());
        self.epochs += 1;
        (self.epoch, self.commands) = (self.epoch.wrapping_mul(31).wrapping_add(0x1234_5678_9abc_def0), [0; 2]);
        if recover {
            self.stage = Stage::Running;
        }
        Answer { number: self.epochs, ..self.answered(Code::Done, "") }
    }

    pub fn state(&mut self, number: u64) -> State {
        let (time, owner) = (self.now(), if self.owner.is_some() { self.epochs } else { 0 });
        self.cycle += 1;
        let record = |index: usize| Record {
            finger: Finger::ALL[index],
            stage: self.stage,
            command: self.commands[index],
            cycle: self.cycle,
            begin: time,
            touching: false,
            caught: false,
            arrived: true,
            settled: false,
            joints: self.joints[index],
            set_point: Some(self.joints[index]),
            tip: [1.0, 2.0, 3.0],
            force: [0.5, 0.0, 0.0],
            tensions: [5.0, 6.0, 7.0, 8.0],
        };
        State { missing: 0, number, time, owner, records: vec![record(0), record(1)] }
    }

    pub fn status_payload(&self) -> Vec<u8> {
        let text = if matches!(self.stage, Stage::Faulted(_)) { "it was stopped" } else { "" };
        let finger = FingerStatus {
            stage: self.stage,
            warnings: 0,
            cycles: self.cycle,
            skipped_periods: 0,
            lost_replies: 0,
            corrupt_replies: 0,
            low: [-0.5; 3],
            high: [1.5; 3],
            stiffness_bound: 10.0,
            calibration: 0.0,
            fault_text: FaultText::beginning_of(text),
        };
        let status = Status {
            catch_ms: 100,
            end_ms: 1000,
            clients: 1,
            time: self.now(),
            rate: 1000.0,
            lead_force: 10.0,
            soft_stiffness: 1.0,
            counts: Counts::default(),
            fingers: [Some(finger.clone()), Some(finger), None],
            owner: self.owner.clone(),
        };
        let mut payload = status.encode().expect("a good Status");
        payload[1] = self.version;
        payload
    }
}
