"""Reads a recording with the MCAP reader and the ROS 2 decoder for Python. Prints what it has found as JSON."""

import json
import math
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def plain(value):
    """Converts a decoded value to what JSON has. NaN stands for a missing value."""
    if isinstance(value, (list, tuple)) or type(value).__name__ in ("array", "ndarray"):
        values = [plain(item) for item in value]
        return None if values and all(item is None for item in values) else values
    if isinstance(value, float) and math.isnan(value):
        return None
    return value


cycles = [0, 0, 0]
last = None
description = None
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    topics = ["/finger1/cycle", "/finger2/cycle", "/finger3/cycle"]
    for schema, channel, message, decoded in reader.iter_decoded_messages(topics=topics):
        finger = int(channel.topic[len("/finger")])
        cycles[finger - 1] += 1
        if finger == 1:
            last = {name: plain(getattr(decoded, name)) for name in decoded.__slots__ if not name.startswith("_")}
    file.seek(0)
    for schema, channel, message in make_reader(file).iter_messages(topics=["/description"]):
        assert schema.encoding == "jsonschema" and json.loads(schema.data)["title"] == "sun2xp.Description"
        description = json.loads(message.data)
json.dump({"cycles": cycles, "last": last, "description": description}, sys.stdout)
