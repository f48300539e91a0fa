"""An importer of functional mock-up units: the same calls for both versions of FMI, by ctypes.

It is written from the standard, and uses nothing of what exports.
"""

import ctypes as ct
import xml.etree.ElementTree as ET
import zipfile

OK, WARNING, DISCARD, ERROR = range(4)

_LOG2 = ct.CFUNCTYPE(None, ct.c_void_p, ct.c_char_p, ct.c_int, ct.c_char_p, ct.c_char_p)
_LOG3 = ct.CFUNCTYPE(None, ct.c_void_p, ct.c_int, ct.c_char_p, ct.c_char_p)


class _Callbacks(ct.Structure):
    _fields_ = (
        ("logger", _LOG2),
        ("allocate", ct.c_void_p),
        ("free", ct.c_void_p),
        ("finished", ct.c_void_p),
        ("environment", ct.c_void_p),
    )


class _EventInfo(ct.Structure):
    _fields_ = (
        ("again", ct.c_int),
        ("terminate", ct.c_int),
        ("nominals", ct.c_int),
        ("values", ct.c_int),
        ("timed", ct.c_int),
        ("time", ct.c_double),
    )


def _doubles(values):
    return (ct.c_double * len(values))(*map(float, values))


def _references(values):
    return (ct.c_uint32 * len(values))(*values)


class Fmu:
    """An unpacked functional mock-up unit."""

    def __init__(self, path, folder):
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        self.folder = folder
        self.root = ET.parse(folder / "modelDescription.xml").getroot()
        self.version = int(self.root.attrib["fmiVersion"][0])
        self.token = self.root.attrib["guid" if self.version == 2 else "instantiationToken"]
        library = next(folder.glob("binaries/*linux*/*.so"))
        self.library = ct.CDLL(str(library))
        variables = self.root.find("ModelVariables")
        assert variables is not None
        self.references = {v.attrib["name"]: int(v.attrib["valueReference"]) for v in variables}
        self.variables = {v.attrib["name"]: v for v in variables}

    def attribute(self, name, key):
        """Return an attribute of a variable, wherever the version has it."""
        variable = self.variables[name]
        inner = variable[0] if self.version == 2 else variable
        return {**variable.attrib, **inner.attrib}.get(key)

    def instance(self, kind="CoSimulation", **options):
        """Return an instance."""
        return Instance(self, kind, **options)


class Instance:
    """An instance with its messages."""

    def __init__(self, fmu, kind, *, token=None, logging=False):
        self.fmu, self.messages = fmu, list[str]()
        self.kind = kind
        self._two = fmu.version == 2
        named = (b"one", (fmu.token if token is None else token).encode())
        if self._two:
            self._log = _LOG2(lambda _, __, ___, ____, text: self._note(text))
            self._callbacks = _Callbacks(self._log, None, None, None, None)
            make = fmu.library.fmi2Instantiate
            make.restype = ct.c_void_p
            which = ct.c_int(kind == "CoSimulation")
            made = make(named[0], which, named[1], b"", ct.byref(self._callbacks), 0, int(logging))
        else:
            self._log = _LOG3(lambda _, __, ___, text: self._note(text))
            make = getattr(fmu.library, f"fmi3Instantiate{kind}")
            make.restype = ct.c_void_p
            flags = [ct.c_bool(False), ct.c_bool(logging)]
            if kind == "CoSimulation":
                flags += [ct.c_bool(False), ct.c_bool(False), None, ct.c_size_t(0)]
            made = make(*named, None, *flags, None, self._log, None)
        self.handle = None if made is None else ct.c_void_p(made)

    def _note(self, text):
        message = text.decode()
        self.messages.append(message.replace("%%", "%") if self._two else message)

    @property
    def message(self):
        """Return the last message."""
        return self.messages[-1] if self.messages else ""

    def call(self, two, three=None, *arguments):
        """Call a function by what it is called in each version."""
        name = f"fmi2{two}" if self._two else f"fmi3{two if three is None else three}"
        return getattr(self.fmu.library, name)(self.handle, *arguments)

    def free(self):
        """Free it."""
        self.call("FreeInstance")

    # -- life -----------------------------------------------------------------------------------

    def initialise(self, tolerance=None, start=0.0, **values):
        """Go through initialization mode, with values that are set before; return the worst."""
        known = {name: value for name, value in values.items() if value is not None}
        status = self.set(known) if known else OK
        given = (int(tolerance is not None), ct.c_double(tolerance or 0.0), ct.c_double(start))
        end = (0, ct.c_double(0.0))
        if self._two:
            status = max(status, self.call("SetupExperiment", None, *given, *end))
            status = max(status, self.call("EnterInitializationMode"))
        else:
            status = max(status, self.call("", "EnterInitializationMode", *given, *end))
        return max(status, self.call("ExitInitializationMode"))

    # -- values ---------------------------------------------------------------------------------

    def _of(self, names):
        return _references([self.fmu.references.get(n, n) for n in names])

    def get(self, *names):
        """Return values by name."""
        values = _doubles([0.0] * len(names))
        self.status = self._values("Get", names, values)
        return list(values)

    def set(self, named):
        """Set values by name."""
        return self._values("Set", list(named), _doubles(list(named.values())))

    def _values(self, way, names, values):
        count = ct.c_size_t(len(names))
        more = () if self._two else (count,)
        return self.call(f"{way}Real", f"{way}Float64", self._of(names), count, values, *more)

    def derivative(self, unknowns, knowns, seed, *, adjoint=False):
        """Return a directional or an adjoint derivative."""
        found = _doubles([0.0] * len(knowns if adjoint else unknowns))
        rows, columns = ct.c_size_t(len(unknowns)), ct.c_size_t(len(knowns))
        shared = (self._of(unknowns), rows, self._of(knowns), columns, _doubles(seed))
        if self._two:
            self.status = self.call("GetDirectionalDerivative", None, *shared, found)
        else:
            name = "GetAdjointDerivative" if adjoint else "GetDirectionalDerivative"
            sizes = ct.c_size_t(len(seed)), ct.c_size_t(len(found))
            self.status = self.call("", name, *shared, sizes[0], found, sizes[1])
        return list(found)

    # -- Co-Simulation --------------------------------------------------------------------------

    def step(self, time, length):
        """Take a step; the time that was reached is `reached`."""
        at = ct.c_double(time), ct.c_double(length)
        self.reached = ct.c_double(0.0)
        if self._two:
            status = self.call("DoStep", None, *at, 1)
            self.call("GetRealStatus", None, 2, ct.byref(self.reached))
            return status
        flags = [ct.c_bool() for _ in range(3)]
        results = (*map(ct.byref, flags), ct.byref(self.reached))
        return self.call("DoStep", None, *at, ct.c_bool(True), *results)

    def slopes(self, orders, values):
        """Set derivatives of inputs, by name."""
        given = (ct.c_int * len(orders))(*orders.values())
        count = ct.c_size_t(len(orders))
        return self.call(
            "SetRealInputDerivatives", None, self._of(orders), count, given, _doubles(values)
        )

    # -- Model Exchange -------------------------------------------------------------------------

    def array(self, two, three, count):
        """Return what a function puts into an array."""
        found = _doubles([0.0] * count)
        self.status = self.call(two, three, found, ct.c_size_t(count))
        return list(found)

    def place(self, time, states):
        """Set time and states."""
        status = self.call("SetTime", None, ct.c_double(time))
        given = _doubles(states)
        return max(status, self.call("SetContinuousStates", None, given, ct.c_size_t(len(states))))

    def completed(self):
        """Complete a step of the integrator; return whether the simulation is to end."""
        kind = ct.c_int if self._two else ct.c_bool
        flags = [kind(), kind()]
        self.status = self.call("CompletedIntegratorStep", None, kind(1), *map(ct.byref, flags))
        return bool(flags[1].value)

    def update(self):
        """Update discrete states; return whether the simulation is to end."""
        if self._two:
            info = _EventInfo()
            self.status = self.call("NewDiscreteStates", None, ct.byref(info))
            return bool(info.terminate)
        flags = [ct.c_bool() for _ in range(5)]
        results = (*map(ct.byref, flags), ct.byref(ct.c_double()))
        self.status = self.call("", "UpdateDiscreteStates", *results)
        return flags[1].value

    # -- saved ----------------------------------------------------------------------------------

    def save(self):
        """Return a saved state."""
        saved = ct.c_void_p()
        assert self.call("GetFMUstate", "GetFMUState", ct.byref(saved)) == OK
        return saved

    def restore(self, saved):
        """Go back to a saved state."""
        return self.call("SetFMUstate", "SetFMUState", saved)

    def bytes_of(self, saved):
        """Return a saved state as bytes."""
        size = ct.c_size_t()
        self.call("SerializedFMUstateSize", "SerializedFMUStateSize", saved, ct.byref(size))
        content = ct.create_string_buffer(size.value)
        assert self.call("SerializeFMUstate", "SerializeFMUState", saved, content, size) == OK
        return content.raw

    def from_bytes(self, content):
        """Return a saved state that bytes are of; None where they are of none."""
        saved, size = ct.c_void_p(), ct.c_size_t(len(content))
        given = ct.create_string_buffer(content, len(content))
        name = "DeSerializeFMUstate", "DeserializeFMUState"
        return saved if self.call(*name, given, size, ct.byref(saved)) == OK else None
