"""Files of the formats that ffd lattice convert reads, as other programs write them, byte by byte."""

import base64
import io
import math
import struct
import zipfile
import zlib


def npy(descr, shape, data):
    """An array file of any type, of C order."""
    head = "{'descr': '%s', 'fortran_order': False, 'shape': %s, }" % (descr, shape)
    head += " " * (-(10 + len(head) + 1) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode() + data


def refitter(size, types, rotation, location, scale, rest, deformed, kind="f", packed=True, version=3, **others):
    """A lattice of Blender as body refitters keep it. rotation: by rows."""
    r = rotation
    w = math.sqrt(1 + r[0][0] + r[1][1] + r[2][2]) / 2
    quaternion = [w, (r[2][1] - r[1][2]) / (4 * w), (r[0][2] - r[2][0]) / (4 * w), (r[1][0] - r[0][1]) / (4 * w)]

    def numbers(values, shape):
        return npy("<f4" if kind == "f" else "<f8", shape, struct.pack(f"<{len(values)}{kind}", *values))

    members = {"magic": npy("|S4", "(1,)", b"LATZ"), "version": npy("<u2", "(1,)", struct.pack("<H", version)), "name": npy("|S64", "(1,)", b"x" * 64),
               "interp": npy("|S16", "(3,)", b"".join(t.encode().ljust(16, b"\0") for t in types)), "location": numbers(location, "(3,)"),
               "rotation_quat": numbers(quaternion, "(4,)"), "scale": numbers(scale, "(3,)"), "use_outside": npy("|u1", "(1,)", b"\0")}
    members.update({name: npy("<u2", "(1,)", struct.pack("<H", n)) for name, n in zip("UVW", size)})
    members.update({name: numbers([x for p in points for x in p], f"({len(points)}, 3)") for name, points in (("points_rest", rest), ("points_deform", deformed))})
    members.update(others)
    file, streams = io.BytesIO(), {name: data for name, data in members.items() if isinstance(data, tuple)}
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED if packed else zipfile.ZIP_STORED) as archive:
        for name, data in members.items():
            if data is not None:
                archive.writestr(name + ".npy", b"" if name in streams else data)
    return zipped(file.getvalue(), streams=streams) if streams else file.getvalue()


def entries_of(data):
    """The members of a ZIP file as the fields of their entries, with their bytes as they are packed."""
    found = []
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for info in archive.infolist():
            at = info.header_offset + 30 + sum(struct.unpack_from("<HH", data, info.header_offset + 26))
            found.append({"name": info.filename, "flags": 0, "method": info.compress_type, "crc": info.CRC, "packed": info.compress_size,
                          "size": info.file_size, "data": data[at:at + info.compress_size]})
    return found


def zipped(data, streams=(), encrypted=None, double=None, with_data=b"", descriptors=False, shift=0, count=None, start=None, **fields):
    """A ZIP file once more, with faults.

    streams: deflate streams and what the directory tells of their size, in place of members; double: a member that is there twice;
    descriptors: with sizes behind the data, as into a pipe; shift: of offsets; count, start: of the directory; fields: (member, value)
    of an entry of the directory: method, crc, packed, size, header."""
    entries, body, directory = entries_of(data), b"", b""
    if double:
        entries.append({"name": double + ".npy", "flags": 0, "method": 0, "crc": zlib.crc32(with_data), "packed": len(with_data), "size": len(with_data), "data": with_data})
        entries += [dict(entries[-1])] if double == "x" else []
    for entry in entries:
        short = entry["name"][:-len(".npy")]
        if short in streams:
            entry["data"], entry["size"] = streams[short]
            entry |= {"method": 8, "packed": len(entry["data"])}
        entry["flags"] = (1 if short == encrypted else 0) | (8 if descriptors else 0)
        told = {"header": len(body) + shift, **entry, **{field: value for field, (member, value) in fields.items() if member == short}}
        name, sizes = entry["name"].encode(), struct.pack("<III", entry["crc"], entry["packed"], entry["size"])
        body += struct.pack("<IHHHHH", 0x04034b50, 20, entry["flags"], entry["method"], 0, 33) + (bytes(12) if descriptors else sizes)
        body += struct.pack("<HH", len(name), 0) + name + entry["data"] + (b"PK\7\x08" + sizes if descriptors else b"")
        directory += struct.pack("<IHHHHHHIIIHHHHHII", 0x02014b50, 20, 20, entry["flags"], told["method"], 0, 33, told["crc"], told["packed"], told["size"], len(name),
                                 0, 0, 0, 0, 0, told["header"]) + name
    of = len(entries) if count is None else count
    return body + directory + struct.pack("<IHHHHIIH", 0x06054b50, 0, 0, of, of, len(directory), len(body) + shift if start is None else start, 0)


def plot3d(blocks, front=None):
    """Blocks of (size, points)."""
    lines = [str(len(blocks)) if front is None else front] + [" ".join(map(str, size)) for size, _ in blocks]
    return "\n".join(lines + [" ".join(repr(p[c]) for p in points) for _, points in blocks for c in range(3)]) + "\n"


def grid(n, m, o):
    return [[i * 1.0, j * 2.0, k * 3.0] for k in range(o) for j in range(m) for i in range(n)]


def su2_box(tag, size, blending="BEZIER", order=None, corners=None, points=None, flat=False):
    lines = [f"FFD_TAG= {tag}", "FFD_LEVEL= 0"] + [f"FFD_DEGREE_{d}= {n - 1}" for d, n in zip("IJK", size)]
    lines += [f"FFD_BLENDING= {blending}"] + [f"BSPLINE_ORDER_{d}= {o}" for d, o in zip("IJK", order or [])]
    corners = corners or [[x, y] if flat else [x, y, z] for z in ((0,) if flat else (0, 3)) for x, y in ((0, 0), (2, 0), (2, 1), (0, 1))]
    lines += ["FFD_PARENTS= 0", "FFD_CHILDREN= 0", f"FFD_CORNER_POINTS= {len(corners)}"] + ["\t".join(map(str, c)) for c in corners]
    lines += [f"FFD_CONTROL_POINTS= {len(points or [])}"] + ["\t".join(map(str, p)) for p in points or []] + ["FFD_SURFACE_POINTS= 1", "wall\t7\t0.5\t0.5\t0.5"]
    return "\n".join(lines) + "\n"


SU2 = "NDIME= 3\nNELEM= 1\n10 0 1 2 3 0\nNPOIN= 1\n0 0 0 0\nNMARK= 0\nFFD_NBOX= 2\nFFD_NLEVEL= 1\n"


class Vts:
    """A grid as VTK writes it in XML: within the file as base64, or appended, plain or in blocks of zlib."""

    def __init__(self, place, packed, order="LittleEndian", header="UInt64", encoding="raw", block=100, excess=0):
        self.place, self.packed, self.encoding, self.block, self.excess = place, packed, encoding, block, excess
        self.end, self.word, self.appended = "<" if order == "LittleEndian" else ">", "I" if header == "UInt32" else "Q", b""
        compressor = ' compressor="vtkZLibDataCompressor"' if packed else ""
        self.front = f'<?xml version="1.0"?>\n<!-- a > within -->\n<VTKFile type="StructuredGrid" version="1.0" byte_order="{order}" header_type="{header}"{compressor}>\n'

    def array(self, name, components, values, kind="d"):
        data = struct.pack(f"{self.end}{len(values)}{kind}", *values)
        if self.packed:
            blocks = [data[i:i + self.block] for i in range(0, len(data), self.block)]
            packed = [zlib.compress((block + b"x")[:len(block) + self.excess]) for block in blocks]
            last = len(blocks[-1]) % self.block
            head = struct.pack(f"{self.end}{3 + len(blocks)}{self.word}", len(blocks), self.block, last, *map(len, packed))
            raw, text = head + b"".join(packed), base64.b64encode(head) + base64.b64encode(b"".join(packed))
        else:
            raw = struct.pack(self.end + self.word, len(data)) + data
            text = base64.b64encode(raw)
        tag = f'<DataArray type="{"Float64" if kind == "d" else "Float32"}" Name="{name}" NumberOfComponents="{components}" '
        if self.place == "binary":
            return tag + f'format="binary">\n  {text.decode()}\n</DataArray>\n'
        offset = len(self.appended)
        self.appended += raw if self.encoding == "raw" else text
        return tag + f'format="appended" offset="{offset}"/>\n'

    def file(self, points, offsets, extent="0 2 0 3 0 1", kind="d"):
        text = self.front + f'<StructuredGrid WholeExtent="{extent}">\n<Piece Extent="{extent}">\n<PointData Vectors="offset">\n'
        text += self.array("offset", 3, [x for p in offsets for x in p], kind) + '<DataArray type="Int32" Name="other" format="ascii">1 2 3</DataArray>\n'
        text += "</PointData>\n<CellData/>\n<Points>\n" + self.array("Points", 3, [x for p in points for x in p], kind) + "</Points>\n</Piece>\n</StructuredGrid>\n"
        tail = f'<AppendedData encoding="{self.encoding}">\n   _'.encode() + self.appended + b"\n</AppendedData>\n" if self.appended else b""
        return text.encode() + tail + b"</VTKFile>\n"
