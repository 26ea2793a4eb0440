"""Messages of the library go to the Python module `logging`."""

import logging
import os
import subprocess
import sys
import time

import sun2xp


def run(program, folder, **variables):
    environment = {**os.environ, "SUN2XP_CONFIG": "", **variables}
    options = dict(capture_output=True, text=True, timeout=60, cwd=folder, env=environment)
    result = subprocess.run([sys.executable, "-c", program], **options)
    assert result.returncode == 0, result.stderr
    return result


def test_warnings_of_opening_are_in_the_log_when_open_returns(tmp_path):
    program = (
        "import logging, sun2xp\n"
        "texts = []\n"
        "class Keep(logging.Handler):\n"
        "    def emit(self, record):\n"
        "        texts.append((record.name, record.levelname, record.getMessage()))\n"
        "logging.getLogger('sun2xp').addHandler(Keep())\n"
        "with sun2xp.open():\n"
        "    assert any('simulated' in text for _, _, text in texts), texts\n"
        "    assert {(name, level) for name, level, _ in texts} == {('sun2xp', 'WARNING')}, texts\n"
    )
    # Without a configuration every finger is simulated, and the library warns of this. The handler receives the
    # warning, so nothing goes to standard error.
    assert run(program, tmp_path).stderr == ""


def test_without_a_handler_warnings_go_to_standard_error(tmp_path):
    said = run("import sun2xp\nsun2xp.open().close()", tmp_path).stderr
    assert "simulated" in said


def test_messages_of_the_threads_of_the_library_are_logged(tmp_path, caplog):
    text = f"[hand]\nblack_box = {str(tmp_path)!r}\n[finger]\nport = 'simulated'\n"
    with caplog.at_level(logging.WARNING, "sun2xp"), sun2xp.open(text=text) as hand:
        hand.stop(1)
        deadline = time.monotonic() + 10
        while not any("finger 1 faulted" in record.getMessage() for record in caplog.records):
            assert time.monotonic() < deadline, caplog.text
            time.sleep(0.01)


def test_a_handler_may_open_a_hand_and_a_filter_may_fail(tmp_path):
    program = (
        "import logging, sun2xp\n"
        "hands = []\n"
        "class Open(logging.Handler):\n"
        "    def emit(self, record):\n"
        "        if not hands:\n"
        "            hands.append(None)\n"
        "            hands.append(sun2xp.simulated())\n"
        "logger = logging.getLogger('sun2xp')\n"
        "logger.addHandler(Open())\n"
        "with sun2xp.open():\n"
        "    pass\n"
        "def fail(record): raise RuntimeError('no')\n"
        "logger.addFilter(fail)\n"
        "with sun2xp.open():\n"
        "    pass\n"
        "hands[1].close()\n"
    )
    assert "(not logged: no)" in run(program, tmp_path).stderr


def test_a_forked_child_logs_to_standard_error(tmp_path):
    program = (
        "import os, sun2xp\n"
        "hand = sun2xp.simulated()\n"
        "child = os.fork()\n"
        "if child == 0:\n"
        "    sun2xp.open().close()\n"
        "    os._exit(0)\n"
        "assert os.waitpid(child, 0)[1] == 0\n"
        "hand.close()\n"
    )
    assert "sun2xp: " in run(program, tmp_path).stderr
