"""Tests that `sun2xp.remote` reads the common name from a client's certificate, and refuses damaged certificates."""

import base64

import pytest

import sun2xp
from sun2xp.remote._certificate import common_name


def element(tag, *contents):
    """Returns a DER element whose content has less than 128 bytes."""
    content = b"".join(contents)
    return bytes([tag, len(content)]) + content


def certificate(name):
    """Returns the part of a certificate that is read: the fields up to the subject."""
    attribute = element(0x30, bytes([0x06, 0x03, 0x55, 0x04, 0x03]), element(0x0C, name.encode()))
    fields = [element(0x02, b"\x01"), element(0x30), element(0x30), element(0x30)]
    return element(0x30, element(0x30, *fields, element(0x30, element(0x31, attribute))))


def pem(der):
    return f"-----BEGIN CERTIFICATE-----\n{base64.b64encode(der).decode()}\n-----END CERTIFICATE-----\n"


def test_text_around_the_certificate_may_have_any_letters(tmp_path):
    file = tmp_path / "client.pem"
    file.write_text(f"Subject: O = Müller\n{pem(certificate('planner'))}", encoding="utf-8")
    assert common_name(file) == "planner"
    file.write_bytes(b"Subject: O = M\xfcller\n" + pem(certificate("planner")).encode())
    assert common_name(file) == "planner"


@pytest.mark.parametrize("der", [b"", b"\x30", b"\x30\x00", element(0x30, element(0x30)), certificate("")[:-12]])
def test_a_damaged_certificate_has_no_common_name(tmp_path, der):
    file = tmp_path / "client.pem"
    file.write_text(pem(der))
    with pytest.raises(sun2xp.ConfigurationError, match="has no common name"):
        common_name(file)
