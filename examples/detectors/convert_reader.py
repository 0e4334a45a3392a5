#!/usr/bin/env python3
"""Rewrites PP-OCR's recogniser so that OpenCV 4.6 loads and runs it, for inputs of one size, 320 x 48.

usage: convert_reader.py FROM.onnx TO.onnx

OpenCV 4.6 neither follows shapes that are computed while the network runs nor adds a row of numbers to all rows of a matrix. With
the size known, the first are constants, and the rows are written out. The network computes the same.
"""
import sys

import numpy as np
import onnx
from onnx import helper, mapping, numpy_helper, shape_inference

HEIGHT, WIDTH = 48, 320


def shapes_of(model):
    inferred = shape_inference.infer_shapes(model).graph
    known = {v.name: [d.dim_value for d in v.type.tensor_type.shape.dim] for v in [*inferred.value_info, *inferred.input]}
    return {name: shape for name, shape in known.items() if shape and all(shape)}


def sliced(value, attributes):
    where = [slice(None)] * value.ndim
    for start, end, axis in zip(attributes["starts"], attributes["ends"], attributes["axes"]):
        where[axis] = slice(start, end)
    return value[tuple(where)]


# What the parts of the network that compute shapes, and its weights, are made by.
FOLDED = {
    "Cast": lambda v, a: v[0].astype(mapping.TENSOR_TYPE_TO_NP_TYPE[a["to"]]),
    "Slice": lambda v, a: sliced(v[0], a),
    "Squeeze": lambda v, a: np.squeeze(v[0], tuple(a["axes"])),
    "Concat": lambda v, a: np.concatenate(v, a["axis"]),
    "Mul": lambda v, a: v[0] * v[1],
    "Reshape": lambda v, a: v[0].reshape(v[1]),
    "Transpose": lambda v, a: np.transpose(v[0], a["perm"]),
}


def fold_once(model, constants):
    shapes = shapes_of(model)
    folded = 0
    for node in list(model.graph.node):
        values = [constants.get(name) for name in node.input]
        if node.op_type == "Shape" and node.input[0] in shapes:
            value = np.array(shapes[node.input[0]], np.int64)
        elif node.op_type in FOLDED and all(v is not None for v in values):
            value = FOLDED[node.op_type](values, {a.name: helper.get_attribute_value(a) for a in node.attribute})
        else:
            continue
        constants[node.output[0]] = value = np.ascontiguousarray(value)
        model.graph.initializer.append(numpy_helper.from_array(value, node.output[0]))
        model.graph.node.remove(node)
        folded += 1
    return folded


def write_rows_out(model, constants):
    shapes = shapes_of(model)
    for node in model.graph.node:
        if node.op_type not in ("Add", "Mul", "Sub", "Div"):
            continue
        for i in (0, 1):
            value, shape = constants.get(node.input[i]), shapes.get(node.input[1 - i], [])
            if value is None or value.size == 1 or len(shape) != 3:
                continue
            name = f"{node.output[0]}_rows"
            model.graph.initializer.append(numpy_helper.from_array(np.ascontiguousarray(np.broadcast_to(value, shape)), name))
            node.input[i] = name


def convert(model):
    graph = model.graph
    batch, _, height, width = graph.input[0].type.tensor_type.shape.dim
    if height.dim_value != HEIGHT:
        raise ValueError(f"an input {height.dim_value} px high")
    batch.dim_value, width.dim_value = 1, WIDTH
    for dimension in graph.output[0].type.tensor_type.shape.dim:
        dimension.Clear()
    constants = {i.name: numpy_helper.to_array(i) for i in graph.initializer}
    for node in [n for n in graph.node if n.op_type == "Constant"]:
        constants[node.output[0]] = numpy_helper.to_array(node.attribute[0].t)
        graph.initializer.append(numpy_helper.from_array(constants[node.output[0]], node.output[0]))
        graph.node.remove(node)
    while fold_once(model, constants):
        pass
    write_rows_out(model, constants)
    used = {name for node in graph.node for name in node.input}
    kept = [i for i in graph.initializer if i.name in used]
    del graph.initializer[:]
    graph.initializer.extend(kept)
    onnx.checker.check_model(model)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    network = onnx.load(sys.argv[1])
    convert(network)
    onnx.save(network, sys.argv[2])
