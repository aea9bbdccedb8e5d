"""A glTF asset that grows view by view and accessor by accessor, in one buffer: what the builders of test files
have in common."""

FLOAT, BYTE, UBYTE, SHORT, USHORT, UINT = 5126, 5120, 5121, 5122, 5123, 5125
CODES = {FLOAT: "f", BYTE: "b", UBYTE: "B", SHORT: "h", USHORT: "H", UINT: "I"}  # of struct
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class GltfAsset:
    def __init__(self, **members):
        self.data = bytearray()
        self.asset = {"asset": {"version": "2.0"}, **members, "bufferViews": [], "accessors": []}

    def view(self, data, **members):
        """A new bufferView; its number."""
        self.data += b"\0" * (-len(self.data) % 4)
        self.asset["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **members})
        self.data += data
        return len(self.asset["bufferViews"]) - 1

    def view_accessor(self, view, rows, kind, component, bounds, **members):
        """A new accessor of a view that holds the rows; its number."""
        self.asset["accessors"].append({"bufferView": view, "componentType": component, "count": len(rows),
                                        "type": kind, **members})
        if bounds:
            columns = list(zip(*rows))
            self.asset["accessors"][-1] |= {"min": list(map(min, columns)), "max": list(map(max, columns))}
        return len(self.asset["accessors"]) - 1
