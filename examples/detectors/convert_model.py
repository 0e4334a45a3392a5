#!/usr/bin/env python3
"""Rewrites an ONNX network so that OpenCV 4.6 loads it: x * clip(x + 3, 0, 6) / 6 becomes x * HardSigmoid(x).

usage: convert_model.py FROM.onnx TO.onnx

OpenCV 4.6 does not know Clip with its bounds as inputs. The network computes the same.
"""
import sys

import onnx
from onnx import helper, numpy_helper


def scalar(constants, name):
    value = constants[name].ravel()
    if value.size != 1:
        raise ValueError(f"{name} is not a scalar")
    return float(value[0])


def only_user(users, name, kind):
    found = users.get(name, [])
    if len(found) != 1 or found[0].op_type != kind:
        raise ValueError(f"{name} is not followed by one {kind}")
    return found[0]


def convert(model):
    graph = model.graph
    constants = {n.output[0]: numpy_helper.to_array(n.attribute[0].t) for n in graph.node if n.op_type == "Constant"}
    constants.update({i.name: numpy_helper.to_array(i) for i in graph.initializer})
    maker = {name: node for node in graph.node for name in node.output}
    users = {}
    for node in graph.node:
        for name in node.input:
            users.setdefault(name, []).append(node)
    count = 0
    for clip in [n for n in graph.node if n.op_type == "Clip"]:
        add = maker[clip.input[0]]
        mul = only_user(users, clip.output[0], "Mul")
        div = only_user(users, mul.output[0], "Div")
        bounds = [scalar(constants, name) for name in (add.input[1], clip.input[1], clip.input[2], div.input[1])]
        if add.op_type != "Add" or bounds != [3, 0, 6, 6]:
            raise ValueError(f"{clip.name} is part of another function")
        clip.op_type = "HardSigmoid"
        source = add.input[0]
        del clip.input[:]
        clip.input.append(source)
        clip.attribute.extend([helper.make_attribute("alpha", 1 / 6), helper.make_attribute("beta", 0.5)])
        mul.output[0] = div.output[0]
        graph.node.remove(add)
        graph.node.remove(div)
        count += 1
    # Constants become initialisers; those of the removed nodes go.
    used = {name for node in graph.node for name in node.input}
    known = {i.name for i in graph.initializer}
    for node in [n for n in graph.node if n.op_type == "Constant"]:
        name = node.output[0]
        if name in used and name not in known:
            graph.initializer.append(numpy_helper.from_array(constants[name], name))
        graph.node.remove(node)
    onnx.checker.check_model(model)
    return count


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    network = onnx.load(sys.argv[1])
    if convert(network) == 0:
        sys.exit(f"{sys.argv[1]}: nothing to rewrite")
    onnx.save(network, sys.argv[2])
