# SPDX-License-Identifier: MIT
"""What can befall an input file of a scenario. An edit is a table with one operation:

Any file:
    {truncate = 100}                     the first 100 bytes
    {keep = 0.5}                         the first half
    {patch = {at = 4, hex = "0000"}}     bytes overwritten
    {replace = ["old", "new"]}           in a text; must occur

Marker files in articap's plain CSV (frame,time_s,NAME_x_mm,NAME_y_mm,NAME_z_mm,...):
    {scale = 0.1}                        all positions
    {mirror = "x"}                       an axis changes its sign
    {drop = ["chin"]}                    markers that were never there
    {rename = {chin = "Chin"}}
    {swap = ["left_x", "right_x"]}       two markers carry each other's names
    {blank = {markers = ["a"], frames = [1, 50]}}       missing from frame to frame
    {move = {marker = "a", by_mm = [5, 0, 0]}}          in the frame of reference of the file
    {set = {frame = 3, column = "a_x_mm", value = "inf"}}
    {unit = "m"}                         the header's unit, numbers unchanged
    {frames = [1, 120]}                  only these
    {rate = 2.0}                         the time column runs this much faster, frames unchanged
"""

import csv
import io


class Table:
    """Rows of a plain CSV; cells stay texts until they are changed."""

    def __init__(self, data):
        rows = list(csv.reader(io.StringIO(data.decode())))
        self.header, self.rows = rows[0], rows[1:]

    def bytes(self):
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows([self.header] + self.rows)
        return out.getvalue().encode()

    def columns_of(self, marker):
        columns = [i for i, name in enumerate(self.header)
                   if name.rsplit("_", 2)[0] == marker and i > 1]
        if len(columns) != 3:
            raise ValueError(f"no marker {marker} among {self.header}")
        return columns

    def change(self, columns, function, frames=(0, 10**9)):
        for row in self.rows:
            if frames[0] <= int(row[0]) <= frames[1]:
                for number, column in enumerate(columns):
                    if row[column]:
                        row[column] = function(float(row[column]), number)

    def keep_columns(self, columns):
        self.header = [self.header[i] for i in columns]
        self.rows = [[row[i] for i in columns] for row in self.rows]


def scale(table, factor):
    table.change(range(2, len(table.header)), lambda value, _: repr(value * factor))


def mirror(table, axis):
    columns = [i for i, name in enumerate(table.header) if i > 1 and name.split("_")[-2] == axis]
    table.change(columns, lambda value, _: repr(-value))


def drop(table, markers):
    gone = {column for marker in markers for column in table.columns_of(marker)}
    table.keep_columns([i for i in range(len(table.header)) if i not in gone])


def rename(table, names):
    places = [(table.columns_of(old), new) for old, new in names.items()]
    for columns, new in places:
        for column in columns:
            table.header[column] = "_".join([new] + table.header[column].rsplit("_", 2)[1:])


def swap(table, markers):
    rename(table, {markers[0]: markers[1], markers[1]: markers[0]})


def blank(table, what):
    for marker in what["markers"]:
        table.change(table.columns_of(marker), lambda value, _: "", what["frames"])


def move(table, what):
    table.change(table.columns_of(what["marker"]),
                 lambda value, axis: repr(value + what["by_mm"][axis]),
                 what.get("frames", (0, 10**9)))


def set_cell(table, what):
    for row in table.rows:
        if int(row[0]) == what["frame"]:
            row[table.header.index(what["column"])] = what["value"]


def unit(table, name):
    table.header = [text.removesuffix("_mm") + "_" + name if text.endswith("_mm") else text
                    for text in table.header]


def frames(table, limits):
    table.rows = [row for row in table.rows if limits[0] <= int(row[0]) <= limits[1]]


def rate(table, factor):
    for row in table.rows:
        row[1] = repr(float(row[1]) / factor)


TABLE_EDITS = {"scale": scale, "mirror": mirror, "drop": drop, "rename": rename, "swap": swap,
               "blank": blank, "move": move, "set": set_cell, "unit": unit, "frames": frames,
               "rate": rate}


def apply(data, wanted):
    for edit in wanted:
        (operation, value), = edit.items()
        if operation == "truncate":
            data = data[:value]
        elif operation == "keep":
            data = data[:int(len(data) * value)]
        elif operation == "patch":
            patch = bytes.fromhex(value["hex"])
            data = data[:value["at"]] + patch + data[value["at"] + len(patch):]
        elif operation == "replace":
            old, new = (text.encode() for text in value)
            if old not in data:
                raise ValueError(f"{value[0]!r} does not occur")
            data = data.replace(old, new)
        else:
            table = Table(data)
            TABLE_EDITS[operation](table, value)
            data = table.bytes()
    return data
