//! Frames with header and fields, and their bytes on the wire. On the wire, a frame has a check, is byte-stuffed, and
//! ends with a zero.

use super::fields::{FieldReader, FieldWriter};
use super::packet::{CHECK, MAX_FRAME, MAX_WIRE, PREFIX, WIRE_OVERHEAD, check};
use super::{
    Command, Configure, Configured, Hello, Identity, Kind, Malformed, Packet, Refused, Reply, Stop, Stopped,
    TactileEvent, TactileRequest,
};

impl Kind {
    /// Returns the length of the body, bytes. Every type has one length.
    pub const fn body_length(self) -> usize {
        match self {
            Kind::Hello => Hello::LENGTH,
            Kind::Configure => Configure::LENGTH,
            Kind::Command => Command::LENGTH,
            Kind::Stop => Stop::LENGTH,
            Kind::TactileRequest => TactileRequest::LENGTH,
            Kind::Identity => Identity::LENGTH,
            Kind::Configured => Configured::LENGTH,
            Kind::Reply => Reply::LENGTH,
            Kind::Stopped => Stopped::LENGTH,
            Kind::Refused => Refused::LENGTH,
            Kind::TactileEvent => TactileEvent::LENGTH,
        }
    }

    /// Returns the length on the wire, bytes, with check, byte stuffing and delimiter.
    pub const fn wire_length(self) -> usize {
        PREFIX + self.body_length() + CHECK + WIRE_OVERHEAD
    }
}

/// The fields of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "each variant has the fields of the frame type of the same name")]
pub enum Frame {
    Hello(Hello),
    Configure(Configure),
    Command(Command),
    Stop(Stop),
    TactileRequest(TactileRequest),
    Identity(Identity),
    Configured(Configured),
    Reply(Reply),
    Stopped(Stopped),
    Refused(Refused),
    TactileEvent(TactileEvent),
}

/// A frame with its header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message {
    /// The address of the finger that is addressed or that answers, 1 to 15. Only a Hello may have the address 0.
    pub address: u8,
    /// The sequence number, which the host chooses and the board copies.
    pub sequence: u8,
    /// The fields.
    pub frame: Frame,
}

impl Frame {
    /// Returns the frame's type.
    pub fn kind(&self) -> Kind {
        match self {
            Frame::Hello(_) => Kind::Hello,
            Frame::Configure(_) => Kind::Configure,
            Frame::Command(_) => Kind::Command,
            Frame::Stop(_) => Kind::Stop,
            Frame::TactileRequest(_) => Kind::TactileRequest,
            Frame::Identity(_) => Kind::Identity,
            Frame::Configured(_) => Kind::Configured,
            Frame::Reply(_) => Kind::Reply,
            Frame::Stopped(_) => Kind::Stopped,
            Frame::Refused(_) => Kind::Refused,
            Frame::TactileEvent(_) => Kind::TactileEvent,
        }
    }

    fn write(&self, fields: &mut FieldWriter) {
        match self {
            Frame::Hello(frame) => frame.write(fields),
            Frame::Configure(frame) => frame.write(fields),
            Frame::Command(frame) => frame.write(fields),
            Frame::Stop(_) => {}
            Frame::TactileRequest(frame) => frame.write(fields),
            Frame::Identity(frame) => frame.write(fields),
            Frame::Configured(frame) => frame.write(fields),
            Frame::Reply(frame) => frame.write(fields),
            Frame::Stopped(frame) => frame.write(fields),
            Frame::Refused(frame) => frame.write(fields),
            Frame::TactileEvent(frame) => frame.write(fields),
        }
    }
}

impl Message {
    /// Reads a frame with a correct check.
    pub fn read(packet: &Packet) -> Result<Self, Malformed> {
        let kind = Kind::from_number(packet.kind()).ok_or(Malformed::UnknownKind(packet.kind()))?;
        if packet.body().len() != kind.body_length() {
            return Err(Malformed::Length { kind, expected: kind.body_length(), found: packet.body().len() });
        }
        let fields = &mut FieldReader::new(packet.body());
        let frame = match kind {
            Kind::Hello => Frame::Hello(Hello::read(fields)),
            Kind::Configure => Frame::Configure(Configure::read(fields, kind)?),
            Kind::Command => Frame::Command(Command::read(fields)),
            Kind::Stop => Frame::Stop(Stop),
            Kind::TactileRequest => Frame::TactileRequest(TactileRequest::read(fields)),
            Kind::Identity => Frame::Identity(Identity::read(fields)),
            Kind::Configured => Frame::Configured(Configured::read(fields)?),
            Kind::Reply => Frame::Reply(Reply::read(fields)),
            Kind::Stopped => Frame::Stopped(Stopped::read(fields)),
            Kind::Refused => Frame::Refused(Refused::read(fields)),
            Kind::TactileEvent => Frame::TactileEvent(TactileEvent::read(fields)),
        };
        Ok(Self { address: packet.address(), sequence: packet.sequence(), frame })
    }
}

/// A frame ready to be sent, with its delimiter.
#[derive(Clone, Copy, Debug)]
pub struct WireFrame {
    bytes: [u8; MAX_WIRE],
    length: usize,
}

impl WireFrame {
    /// Encodes a message: adds check, byte stuffing and delimiter.
    pub fn new(message: &Message) -> Self {
        let mut content = [0; MAX_FRAME];
        let mut fields = FieldWriter::new(&mut content);
        fields.u8((message.frame.kind() as u8) << 4 | message.address & 0x0F);
        fields.u8(message.sequence);
        message.frame.write(&mut fields);
        let check = check(fields.written());
        fields.u32(check);

        let mut bytes = [0; MAX_WIRE];
        // `cobs::encode` panics if the destination is too small. MAX_WIRE bytes hold any frame after stuffing.
        let stuffed = cobs::encode(fields.written(), &mut bytes);
        // The buffer was filled with zeros, so the delimiter is already there.
        Self { bytes, length: stuffed + 1 }
    }

    /// Returns the bytes to send.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}
