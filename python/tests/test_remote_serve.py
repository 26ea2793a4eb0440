"""`sun2xp.remote` with `sun2xp serve` and simulated hands: without and with certificates, and behind a router."""

import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time

import numpy
import pytest

import sun2xp
import sun2xp.remote

#: Path of the program sun2xp-serve. tests/installed sets SUN2XP_SERVE.
SERVER = os.environ.get("SUN2XP_SERVE")

pytestmark = pytest.mark.skipif(SERVER is None, reason="SUN2XP_SERVE does not name the program sun2xp-serve")

HOME = [0.0, 0.6, 0.9]

#: Allowed age of the data that a client reads, s. It is long because the machine may be busy. test_remote.py tests the
#: refusal of old data.
STALE = 1.0


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Server:
    """A server with a simulated hand, or a router."""

    def __init__(self, folder, text, *arguments):
        folder.mkdir(exist_ok=True)
        self.file = folder / "sun2xp.toml"
        self.file.write_text(text)
        command = [SERVER, "--config", str(self.file), *arguments]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        last = "router" if "--router" in arguments else "ready"
        assert any(line.startswith(last) for line in self.process.stdout), "the server has ended"

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.process.terminate()
        assert self.process.wait(20) == 0


def settings(name, clients, *, listen="", connect="", tls=None):
    text = f'[finger]\nport = "simulated"\n[telemetry]\nname = "py-{os.getpid()}-{name}"\n[serve]\nname = "{name}"\n'
    text += f'listen = ["{listen}"]\n' if listen else ""
    text += f'connect = ["{connect}"]\n' if connect else ""
    text += "catch_ms = 500\nend_ms = 2000\n"  # The machine may be busy.
    text += "[serve.clients]\n" + "".join(f'{client} = "{may}"\n' for client, may in clients.items())
    if tls is not None:
        text += f'[serve.tls]\nauthority = "{tls / "ca.pem"}"\n'
        text += f'certificate = "{tls / (name + ".pem")}"\nkey = "{tls / (name + ".key")}"\n'
    return text


@pytest.fixture
def endpoint(tmp_path):
    where = f"tcp/127.0.0.1:{free_port()}"
    with Server(tmp_path / "hand", settings("hand", {"planner": "command", "screen": "read"}, listen=where)):
        yield where


def test_a_finger_is_moved_held_and_read(endpoint):
    with sun2xp.remote.open("hand", endpoint, stale=STALE) as hand:
        assert list(sun2xp.remote.discover(endpoint)) == ["hand"]
        hand.send_group([sun2xp.SetPoint(finger, position=HOME) for finger in hand.fingers])
        hand.send_stiffness(1, numpy.diag([2.0, 2.0, 1.0]))
        hand.wait(condition="settled", timeout=30)
        for finger in hand.fingers:
            assert abs(hand.position(finger) - HOME).max() < 0.05
        hand.send_path(1, [0.5, 1.0], [[0.0, 0.7, 0.9], HOME])
        hand.send_damping(1, 1.2)
        hand.wait(1, timeout=30)
        assert abs(hand.position(1) - HOME).max() < 0.05
        with pytest.raises(sun2xp.Refused):
            hand.send_tip(2, [100.0, 0.0, 0.0])
            hand.wait(2, timeout=10)
        with sun2xp.remote.open("hand", endpoint, client="screen", read_only=True, stale=STALE) as screen:
            assert abs(screen.position(1) - HOME).max() < 0.05
            with pytest.raises(sun2xp.remote.NotOwner):
                screen.acquire(take_over=True)
            screen.stop(3)
        end = time.monotonic() + 10
        while hand.state(3).stage != "faulted" and time.monotonic() < end:
            time.sleep(0.01)  # The state with the fault comes after the answer to the stop.
        with pytest.raises(sun2xp.Fault):
            hand.wait(3, timeout=10)
        hand.recover(3)
        assert hand.status().owner == "planner" and hand.status().counts.malformed == 0
        for _ in range(2):  # The second time the finger is already there.
            hand.send_position(3, HOME)
            hand.wait(3, timeout=30)


def test_a_planner_that_is_stopped_loses_the_hand(endpoint):
    program = (
        "import sun2xp.remote, sys, time\n"
        f"hand = sun2xp.remote.open('hand', sys.argv[1], stale={STALE})\n"
        f"hand.send_position(1, {HOME})\n"
        "hand.wait(1, timeout=30)\n"
        "print('holds', flush=True)\n"
        "time.sleep(60)\n"
    )
    command = [sys.executable, "-c", program, endpoint]
    planner = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert planner.stdout.readline() == "holds\n"
        with sun2xp.remote.open("hand", endpoint, client="screen", read_only=True, stale=STALE) as screen:
            assert screen.status().owner == "planner"
            seen = {screen.state(1).caught}
            planner.send_signal(signal.SIGSTOP)
            end = time.monotonic() + 20
            while (screen.status().owner, screen.state(1).stage) != (None, "faulted") and time.monotonic() < end:
                if screen.state(1).stage == "running":
                    seen.add(screen.state(1).caught)
                time.sleep(0.01)  # Without a pause, the thread that receives would wait for the interpreter lock.
            assert seen == {False, True} and screen.state(1).stage == "faulted"
            status = screen.status()
            assert status.owner is None and (status.counts.caught, status.counts.ended) == (1, 1)
    finally:
        planner.kill()
        planner.wait()
    with sun2xp.remote.open("hand", endpoint, stale=STALE) as hand:
        hand.send_position(1, HOME)
        hand.wait(1, timeout=30)


def test_certificates_name_the_client(tmp_path):
    folder = tmp_path / "certificates"
    names = ["--server", "hand", "--address", "127.0.0.1", "--client", "planner", "--client", "stranger"]
    subprocess.run([SERVER, "--make-certificates", folder, *names], check=True, stdout=subprocess.DEVNULL)
    endpoint = f"tls/127.0.0.1:{free_port()}"

    def tls(client):
        return sun2xp.remote.Tls(folder / "ca.pem", folder / f"{client}.pem", folder / f"{client}.key")

    with Server(tmp_path / "hand", settings("hand", {"planner": "command"}, listen=endpoint, tls=folder)):
        with sun2xp.remote.open("hand", endpoint, tls=tls("planner"), stale=STALE) as hand:
            assert hand.status().owner == "planner"
            hand.send_position(1, HOME)
            hand.wait(1, timeout=30)
        with pytest.raises(sun2xp.remote.NoAnswer):
            sun2xp.remote.open("hand", endpoint, tls=tls("stranger"))
        with pytest.raises(sun2xp.remote.NoAnswer):
            sun2xp.remote.open("hand", endpoint, tls=tls("planner"), client="stranger")
        with pytest.raises(sun2xp.remote.NoAnswer):
            sun2xp.remote.open("hand", endpoint.replace("tls", "tcp"))
    with pytest.raises(sun2xp.ConfigurationError):
        sun2xp.remote.open("hand", endpoint, tls=sun2xp.remote.Tls(pathlib.Path("a"), pathlib.Path("b"), "c"))


def test_two_hands_behind_a_router_move_together(tmp_path):
    router = f"tcp/127.0.0.1:{free_port()}"
    clients = {"planner": "command"}
    with Server(tmp_path / "router", settings("router", clients, listen=router), "--router"):
        left = settings("left", clients, connect=router)
        right = settings("right", clients, connect=router)
        with Server(tmp_path / "left", left), Server(tmp_path / "right", right):
            with sun2xp.remote.connect(router) as network:
                end = time.monotonic() + 10
                while set(network.hands()) != {"left", "right"}:
                    assert time.monotonic() < end
                hands = [network.open(name) for name in ("left", "right")]
                points = [sun2xp.SetPoint(finger, position=HOME) for finger in (1, 2, 3)]
                sun2xp.remote.send_together({hand: points for hand in hands})
                for hand in hands:
                    hand.wait(timeout=30)
                    assert abs(hand.position(2) - HOME).max() < 0.05


def snippets():
    page = (pathlib.Path(__file__).parents[2] / "docs/remote.md").read_text()
    return re.findall(r"```python\n(.*?)```", page, re.DOTALL)


@pytest.mark.parametrize("number", [0, 1])
def test_a_snippet_of_the_page_runs(number, endpoint, tmp_path):
    assert len(snippets()) == 2
    snippet = snippets()[number]
    assert snippet.count("tcp/127.0.0.1:7447") == 1
    program = snippet.replace("tcp/127.0.0.1:7447", endpoint)
    run = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=100)
    assert run.returncode == 0, run.stderr
