"""Command lines in forked copies of a process that has the program loaded: tests/support/driver.c.

Starting the program takes most of the time of a short run. Where the process itself is not what is tested, a run
costs a fork."""
import os
import selectors
import socket
import struct
import subprocess
import time

MOST_BYTES = 1 << 16  # of a command line with its environment


class Driver:
    def __init__(self, path):
        here, there = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.channel = here
        self.process = subprocess.Popen([path, str(there.fileno())], pass_fds=[there.fileno()], stdin=subprocess.DEVNULL,
                                        # Symbols are looked up once, and not in each copy.
                                        env={**os.environ, "LD_BIND_NOW": "1", "MALLOC_PERTURB_": "0"})
        there.close()
        # At its end already: what reads from it gets nothing.
        self.nothing, end = os.pipe()
        os.close(end)

    def close(self):
        """Ends the process. Returns its exit code."""
        self.channel.close()
        os.close(self.nothing)
        return self.process.wait()

    def kill(self):
        """Ends the process and the run that it waits for."""
        self.process.kill()
        self.close()

    def start(self, command, folder, streams):
        """Starts a run on three descriptors. False where the driver cannot take the command line."""
        variables = [os.fsencode(name) + b"=" + os.fsencode(value) for name, value in os.environ.items()]
        words = [os.fsencode(word) for word in command]
        mask = os.umask(0)
        os.umask(mask)
        packet = struct.pack("=III", len(words), len(variables), mask) + b"".join(
            text + b"\0" for text in (os.fsencode(folder), *words, *variables))
        if len(packet) > MOST_BYTES:
            return False
        socket.send_fds(self.channel, [packet], streams)
        return True

    def ended(self):
        """Waits for the end of the run that was started. Returns its exit code, as subprocess tells it."""
        answer = self.channel.recv(4)
        if len(answer) != 4:
            raise AssertionError(f"the driver ended with {self.process.wait()}")
        return os.waitstatus_to_exitcode(struct.unpack("=i", answer)[0])

    def run(self, command, folder, stdin, seconds):
        """As subprocess.run with pipes for the three streams. None where the driver cannot take the command line."""
        pipes = [os.pipe() for _ in range(3 if stdin else 2)]
        theirs = [pipes[2][0] if stdin else self.nothing, pipes[0][1], pipes[1][1]]
        ours = [pipes[0][0], pipes[1][0], *(pipe[1] for pipe in pipes[2:])]
        started = self.start(command, folder, theirs)
        for end in theirs[0 if stdin else 1:] if started else theirs[0 if stdin else 1:] + ours:
            os.close(end)
        if not started:
            return None
        out, err = self._talk(*ours, stdin=stdin, command=command, seconds=seconds)
        return subprocess.CompletedProcess(command, self.ended(), out, err)

    def _talk(self, out, err, into=None, *, stdin, command, seconds):
        """Gives stdin to the run and takes what it writes, until it has closed both streams."""
        taken = {out: [], err: []}
        left = memoryview(stdin)
        end = time.monotonic() + seconds
        with selectors.PollSelector() as selector:
            for stream in (out, err):
                selector.register(stream, selectors.EVENT_READ)
            if into is not None:
                os.set_blocking(into, False)
                selector.register(into, selectors.EVENT_WRITE)
            while selector.get_map():
                ready = selector.select(max(0, end - time.monotonic()))
                if not ready and time.monotonic() >= end:
                    self.kill()
                    raise subprocess.TimeoutExpired(command, seconds)
                for key, _ in ready:
                    if key.fd == into:
                        left = self._give(into, left)
                        done = not left
                    else:
                        block = os.read(key.fd, 65536)
                        taken[key.fd].append(block)
                        done = not block
                    if done:
                        selector.unregister(key.fd)
                        os.close(key.fd)
        return b"".join(taken[out]), b"".join(taken[err])

    @staticmethod
    def _give(into, left):
        try:
            return left[os.write(into, left[:65536]):]
        except BrokenPipeError:  # it reads no more, which it may
            return left[:0]
