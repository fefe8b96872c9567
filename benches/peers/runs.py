"""What the jobs of benches/run share: a program's answer, and the best of its runs. Needs no package."""
import json
import subprocess
import sys


def answers(command, environment):
    """The lines of a command's output that are JSON, or None with the reason on stderr."""
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        print(f"  failed: {(done.stderr.strip().splitlines() or ['no output'])[-1]}", file=sys.stderr)
        return None
    return [json.loads(line) for line in lines]


def best_of(name, programs, arguments, once, took):
    """Of each program the best of `arguments.repeats` runs at each number of threads, by `took(result, threads)`; the programs
    take turns. `once(program, threads)` gives a result, or None."""
    runs = {program: {} for program in programs}
    for threads in arguments.threads:
        for _ in range(arguments.repeats):
            for program in runs:
                print(f"{name}: {program}, {threads} thread(s)", flush=True)
                result = once(program, threads)
                best = runs[program].get(threads)
                if result and (best is None or took(result, threads) < took(best, threads)):
                    runs[program][threads] = result
    return runs
