"""The common name of a certificate, which is the name of the client."""

from __future__ import annotations

import base64
import os
import pathlib
import re
from typing import Iterator, Tuple, Union

from .._errors import ConfigurationError, ErrorNumber

_BLOCK = re.compile(r"-----BEGIN CERTIFICATE-----(.*?)-----END CERTIFICATE-----", re.DOTALL)

#: The object identifier of commonName, 2.5.4.3, in DER with its tag and length.
_COMMON_NAME = bytes([0x06, 0x03, 0x55, 0x04, 0x03])


def common_name(path: Union[str, os.PathLike[str]]) -> str:
    """Returns the common name of the subject of the first certificate of a PEM file.

    Raises:
        ConfigurationError: the file cannot be read, or has no certificate, or the certificate has no common name.
    """
    try:
        block = _BLOCK.search(pathlib.Path(path).read_text("utf-8", "replace"))
        if block is not None:
            return _subject_name(base64.b64decode(block.group(1)))
        reason = "it has no certificate in PEM"
    except OSError as error:
        reason = str(error)
    except (ValueError, IndexError, StopIteration):
        reason = "its certificate is damaged or has no common name"
    text = f"{path} is not the certificate of a client ({reason}): name this client's .pem file in the argument `tls`"
    raise ConfigurationError(text, number=ErrorNumber.CONFIGURATION)


def _subject_name(certificate: bytes) -> str:
    whole = next(_elements(certificate))[1]
    fields = list(_elements(next(_elements(whole))[1]))
    # The first field may be an explicit version. Serial number, algorithm, issuer and validity follow, and then the
    # subject.
    subject = fields[5 if fields[0][0] == 0xA0 else 4][1]
    begin = subject.index(_COMMON_NAME) + len(_COMMON_NAME)
    return next(_elements(subject[begin:]))[1].decode()


def _elements(data: bytes) -> Iterator[Tuple[int, bytes]]:
    """Yields tag and content of the DER elements of which the data consist."""
    position = 0
    while position < len(data):
        tag, length = data[position], data[position + 1]
        position += 2
        if length & 0x80:
            count = length & 0x7F
            length = int.from_bytes(data[position : position + count], "big")
            position += count
        yield tag, data[position : position + length]
        position += length
