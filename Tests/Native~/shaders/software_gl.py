# SPDX-License-Identifier: MIT
"""Draws with Mesa's software OpenGL, in memory, without a display: libOSMesa by ctypes."""

import ctypes
import struct

VERTEX, FRAGMENT = 0x8B31, 0x8B30
FLOAT, UNSIGNED_INT, UNSIGNED_BYTE = 0x1406, 0x1405, 0x1401
ARRAY_BUFFER, ELEMENTS, UNIFORM_BUFFER, TEXTURE_2D = 0x8892, 0x8893, 0x8A11, 0x0DE1
FACTORS = {"Zero": 0, "One": 1, "SrcAlpha": 0x0302, "OneMinusSrcAlpha": 0x0303}


class Picture:
    def __init__(self, size):
        self.size = size
        library = ctypes.CDLL("libOSMesa.so.8")
        library.OSMesaCreateContextAttribs.restype = ctypes.c_void_p
        library.OSMesaGetProcAddress.restype = ctypes.c_void_p
        library.OSMesaMakeCurrent.argtypes = [ctypes.c_void_p] * 2 + [ctypes.c_uint] + [ctypes.c_int] * 2
        self._library = library
        # RGBA, 24 bits of depth, core profile 4.2.
        attributes = (ctypes.c_int * 12)(0x22, 0x1908, 0x30, 24, 0x33, 0x34, 0x36, 4, 0x37, 2, 0, 0)
        self._context = library.OSMesaCreateContextAttribs(attributes, None)
        self._pixels = (ctypes.c_ubyte * (4 * size * size))()
        if not self._context or not library.OSMesaMakeCurrent(
                self._context, ctypes.cast(self._pixels, ctypes.c_void_p), UNSIGNED_BYTE, size, size):
            raise OSError("no OpenGL 4.2 by OSMesa")
        array = ctypes.c_uint(0)
        self.gl("glGenVertexArrays", 1, ctypes.byref(array))
        self.gl("glBindVertexArray", array.value)
        self.gl("glViewport", 0, 0, size, size)
        self.gl("glEnable", 0x0B71)  # depth test
        self.gl("glDepthFunc", 0x0203)  # less or equal, ShaderLab's default

    def gl(self, name, *arguments, result=None):
        address = self._library.OSMesaGetProcAddress(name.encode())
        assert address, name
        kinds = {int: ctypes.c_ssize_t, float: ctypes.c_float}  # other arguments are pointers
        return ctypes.CFUNCTYPE(result)(address)(*[kinds.get(type(one), lambda same: same)(one) for one in arguments])

    def clear(self, color):
        self.gl("glDepthMask", 1)
        self.gl("glColorMask", 1, 1, 1, 1)
        self.gl("glClearColor", *[float(one) for one in color])
        self.gl("glClear", 0x4100)

    def pixel(self, x, y):
        self.gl("glFinish")
        start = 4 * (int((y + 1) / 2 * self.size) * self.size + int((x + 1) / 2 * self.size))
        return tuple(self._pixels[start:start + 4])

    def _buffer(self, target, data):
        name = ctypes.c_uint(0)
        self.gl("glGenBuffers", 1, ctypes.byref(name))
        self.gl("glBindBuffer", target, name.value)
        self.gl("glBufferData", target, len(data), ctypes.create_string_buffer(data, len(data)), 0x88E4)
        return name.value

    def program(self, vertex, fragment):
        program = self.gl("glCreateProgram", result=ctypes.c_uint)
        for kind, text in ((VERTEX, vertex), (FRAGMENT, fragment)):
            shader = self.gl("glCreateShader", kind, result=ctypes.c_uint)
            source = ctypes.c_char_p(text.encode())
            self.gl("glShaderSource", shader, 1, ctypes.byref(source), None)
            self.gl("glCompileShader", shader)
            self.gl("glAttachShader", program, shader)
        self.gl("glLinkProgram", program)
        linked, log = ctypes.c_int(0), ctypes.create_string_buffer(4096)
        self.gl("glGetProgramiv", program, 0x8B82, ctypes.byref(linked))
        if not linked.value:
            self.gl("glGetProgramInfoLog", program, 4096, None, log)
            raise ValueError(log.value.decode())
        return program

    def texture(self, width, height, texels):
        """RGBA bytes whose colours are sRGB; point filter."""
        name = ctypes.c_uint(0)
        self.gl("glGenTextures", 1, ctypes.byref(name))
        self.gl("glBindTexture", TEXTURE_2D, name.value)
        self.gl("glTexParameteri", TEXTURE_2D, 0x2801, 0x2600)
        self.gl("glTexParameteri", TEXTURE_2D, 0x2800, 0x2600)
        self.gl("glTexImage2D", TEXTURE_2D, 0, 0x8C43, width, height, 0, 0x1908, UNSIGNED_BYTE,
                ctypes.create_string_buffer(texels, len(texels)))

    def _set_uniforms(self, program, values):
        """Of all blocks, by the members' names; others are 0."""
        count = ctypes.c_int(0)
        self.gl("glGetProgramiv", program, 0x8A36, ctypes.byref(count))
        for block in range(count.value):
            size, members = ctypes.c_int(0), ctypes.c_int(0)
            self.gl("glGetActiveUniformBlockiv", program, block, 0x8A40, ctypes.byref(size))
            self.gl("glGetActiveUniformBlockiv", program, block, 0x8A42, ctypes.byref(members))
            indices = (ctypes.c_int * members.value)()
            self.gl("glGetActiveUniformBlockiv", program, block, 0x8A43, indices)
            data = bytearray(size.value)
            for index in indices:
                text, offset = ctypes.create_string_buffer(256), ctypes.c_int(0)
                self.gl("glGetActiveUniformName", program, index, 256, None, text)
                self.gl("glGetActiveUniformsiv", program, 1, ctypes.byref(ctypes.c_uint(index)), 0x8A3B, ctypes.byref(offset))
                value = values.get(text.value.decode().split(".")[-1].split("[")[0], ())
                data[offset.value:offset.value + 4 * len(value)] = struct.pack(f"{len(value)}f", *value)
            self.gl("glUniformBlockBinding", program, block, block)
            self.gl("glBindBufferBase", UNIFORM_BUFFER, block, self._buffer(UNIFORM_BUFFER, bytes(data)))

    def draw(self, program, attributes, triangles, uniforms, state):
        """attributes: {part of the name: (components, kind, bytes)}; state: the pass's ShaderLab."""
        self.gl("glUseProgram", program)
        self._set_uniforms(program, uniforms)
        used = ctypes.c_int(0)
        self.gl("glGetProgramiv", program, 0x8B89, ctypes.byref(used))
        for index in range(used.value):
            text, ignored = ctypes.create_string_buffer(256), ctypes.c_int(0)
            self.gl("glGetActiveAttrib", program, index, 256, None, ctypes.byref(ignored), ctypes.byref(ignored), text)
            location = self.gl("glGetAttribLocation", program, text, result=ctypes.c_int)
            components, kind, data = next(value for name, value in attributes.items() if text.value.decode().endswith(name))
            self._buffer(ARRAY_BUFFER, data)
            self.gl("glEnableVertexAttribArray", location)
            if kind == UNSIGNED_INT:
                self.gl("glVertexAttribIPointer", location, components, kind, 0, None)
            else:
                self.gl("glVertexAttribPointer", location, components, kind, int(kind == UNSIGNED_BYTE), 0, None)
        words = state.split()
        self.gl("glDepthMask", 0 if "ZWrite Off" in state else 1)
        mask = 0 if "ColorMask 0" in state else 1
        self.gl("glColorMask", mask, mask, mask, mask)
        if "Blend" in words:
            at = words.index("Blend")
            factors = [FACTORS[word.rstrip(",")] for word in words[at + 1:at + 5]]
            self.gl("glEnable", 0x0BE2)
            self.gl("glBlendFuncSeparate", *factors)
        else:
            self.gl("glDisable", 0x0BE2)
        offset = [float(word.rstrip(",")) for word in words[words.index("Offset") + 1:][:2]] if "Offset" in words else [0.0, 0.0]
        self.gl("glEnable", 0x8037)
        self.gl("glPolygonOffset", *offset)
        self._buffer(ELEMENTS, struct.pack(f"{len(triangles)}I", *triangles))
        self.gl("glDrawElements", 4, len(triangles), UNSIGNED_INT, None)
        error = self.gl("glGetError", result=ctypes.c_uint)
        assert error == 0, hex(error)
