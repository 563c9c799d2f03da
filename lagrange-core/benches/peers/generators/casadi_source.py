"""What CasADi generates, with the signature of the harness."""

import json
import os
import time
from collections import Counter

import casadi as ca

ARITHMETIC = "ADD SUB MUL SQ NEG TWICE DIV INV SQRT".split()
NAMES = {getattr(ca, name): name[3:] for name in dir(ca) if name.startswith("OP_")}


def generate(function, output, inputs=("q", "v", "p"), outputs=("a", "lambda"), header="stddef.h"):
    """CasADi writes into the working folder; a wrapper has the signature of the harness."""
    folder, name = os.path.split(os.path.abspath(output))
    os.chdir(folder)
    function.generate("generated_" + name)
    with open(name, "w") as file:
        file.write(f"""#include "{header}"
#include "generated_{name}"
void accelerations(const double *q, const double *v, const double *p, double *a, double *lambda) {{
    double w[{max(1, function.sz_w())}];
    const double *in[{len(inputs)}] = {{{", ".join(inputs)}}};
    double *out[{len(outputs)}] = {{{", ".join(outputs)}}};
    evaluate(in, out, 0, w, 0);
}}
""")


def report(function, start):
    """Prints what it takes, and how long it took to derive."""
    count = Counter(NAMES[function.instruction_id(k)] for k in range(function.n_instructions()))
    print(
        json.dumps(
            {
                "operations": sum(count[name] for name in ARITHMETIC),
                "functions": count["SIN"] + count["COS"],
                "seconds": time.perf_counter() - start,
            }
        )
    )
