"""Pinocchio: the spanning tree in its C++, the loops closed by Lagrange multipliers.

The tree is that of the SymPy peer (its joints are Pinocchio's own), so that both have the same
coordinates. Mass matrix, bias, Jacobians and drift come from Pinocchio (CRBA, RNEA, forward
kinematics); the four closing equations (ball joint, tie rod's length) are solved with the factor
of the mass matrix in fixed-size Eigen. A tie rod's length is no constraint that Pinocchio has, so
its own constrained dynamics cannot be used without a further body of negligible mass.
"""

import importlib.util
from pathlib import Path

import numpy as np

from .casadi_tree import numbers
from .case import Array, Instant
from .compiled import Source
from .sympy_kane import state as tree_state

ACCELERATIONS = slice(6, 12)
"""Where the accelerations are in the output: arm, two angles, slide, turn, spin."""

_ORDER = (0, 2, 3, 4, 5, 1)
"""Positions of this tree's coordinates among those of the SymPy peer."""

_DEFINITIONS = (
    "NDEBUG",
    "BOOST_MPL_LIMIT_LIST_SIZE=30",
    "BOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "BOOST_FUSION_INVOKE_MAX_ARITY=12",
)
"""Definitions of Pinocchio's own build files for a release."""

_CODE = """
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <Eigen/Cholesky>

namespace {
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

NUMBERS

// Strut frame (along, across, third) to the knuckle's axes (third, along, across).
Matrix3 knuckle_axes() {
    Matrix3 turn;
    turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    return turn;
}

struct Peer {
    pinocchio::Model model;
    pinocchio::Data data;
    pinocchio::JointIndex arm, knuckle;
    Vector3 axis, wheel, rod, arm_ball;

    static pinocchio::SE3 at(const Vector3 &p) { return {Matrix3::Identity(), p}; }

    Peer() {
        using namespace pinocchio;
        const Matrix3 turn = knuckle_axes();
        axis = turn * spin_axis;
        wheel = turn * ::wheel;
        rod = turn * Vector3(::rod[0], ::rod[1], 0);
        arm_ball = Vector3(0, 0, arm_radius);
        Matrix3 arm_turn;  // hinge, lever, hinge x lever to the arm's axes
        arm_turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
        model.gravity.linear() = -gravity * up;
        arm = model.addJoint(
            0, JointModelRevoluteUnaligned(-Vector3::UnitX()), SE3::Identity(), "arm");
        model.appendBodyToJoint(arm, Inertia(control_arm_mass, arm_turn * arm_com,
            Symmetric3(Matrix3(arm_turn * arm_inertia * arm_turn.transpose()))));
        JointIndex last = model.addJoint(0, JointModelRX(), at(strut_top), "x");
        last = model.addJoint(last, JointModelRZ(), SE3::Identity(), "z");
        last = model.addJoint(last, JointModelPY(), SE3::Identity(), "slide");
        knuckle = model.addJoint(last, JointModelRY(), SE3::Identity(), "turn");
        model.appendBodyToJoint(knuckle, Inertia(knuckle_mass, turn * knuckle_com,
            Symmetric3(Matrix3(turn * knuckle_inertia * turn.transpose()))));
        const JointIndex hub = model.addJoint(
            knuckle, JointModelRevoluteUnaligned(axis), at(wheel), "spin");
        const Matrix3 outer = axis * axis.transpose();
        model.appendBodyToJoint(hub, Inertia(wheel_mass, Vector3::Zero(), Symmetric3(Matrix3(
            wheel_inertia_diametral * (Matrix3::Identity() - outer)
            + wheel_inertia_spin * outer))));
        data = Data(model);
    }

    // World-aligned Jacobian, acceleration at zero joint acceleration, of a point of a joint.
    void point(pinocchio::JointIndex joint, const Vector3 &local, Matrix36 &jacobian,
               Vector3 &velocity, Vector3 &drift) {
        const auto &place = data.oMi[joint];
        const Vector3 position = place.act(local);
        jacobian.setZero();
        for (pinocchio::JointIndex j = joint; j > 0; j = model.parents[j]) {
            const int column = model.joints[j].idx_v();
            jacobian.col(column) = data.J.col(column).head<3>()
                + data.J.col(column).tail<3>().cross(position);
        }
        const auto &v = data.v[joint], &a = data.a[joint];
        const Vector3 local_v = v.linear() + v.angular().cross(local);
        const Vector3 local_a = a.linear() + a.angular().cross(local)
            + v.angular().cross(local_v);
        velocity = place.rotation() * local_v;
        drift = place.rotation() * local_a;
    }

    void evaluate(const double *x, double *out) {
        const Eigen::Map<const Vector6> q(x), v(x + 6);
        const Vector6 zero = Vector6::Zero();
        pinocchio::forwardKinematics(model, data, q, v, zero);
        pinocchio::computeJointJacobians(model, data);
        pinocchio::crba(model, data, q);
        pinocchio::nonLinearEffects(model, data, q, v);
        // RNEA has left accelerations with gravity in them elsewhere (a_gf); a is as before.
        Matrix6 mass = data.M.selfadjointView<Eigen::Upper>();

        Matrix36 at_arm, at_ball, at_rod, at_hub;
        Vector3 speed, rod_speed, arm_drift, ball_drift, rod_drift, hub_drift;
        point(arm, arm_ball, at_arm, speed, arm_drift);
        point(knuckle, Vector3::Zero(), at_ball, speed, ball_drift);
        point(knuckle, rod, at_rod, rod_speed, rod_drift);
        point(knuckle, wheel, at_hub, speed, hub_drift);
        const Vector3 span = data.oMi[knuckle].act(rod) - tie_rod_inner;
        Eigen::Matrix<double, 4, 6> closing;
        closing.topRows<3>() = at_ball - at_arm;
        closing.row(3) = span.transpose() * at_rod;
        Eigen::Matrix<double, 4, 1> drift;
        drift.head<3>() = ball_drift - arm_drift;
        drift[3] = span.dot(rod_drift) + rod_speed.squaredNorm();

        const Vector3 turned = data.oMi[knuckle].rotation() * axis;
        const double tilt = up.dot(turned);
        const double height = foot_height + up.dot(data.oMi[knuckle].act(wheel));
        const double pull = -tyre_rate * (height - tyre_free_height) / (1 - tilt * tilt);
        Vector6 right = at_hub.transpose() * (pull * (up - tilt * turned)) - data.nle;
        right[3] += spring_rate * (spring_free_length - q[3]) - damper_rate * v[3];

        const Eigen::LLT<Matrix6> factor(mass);
        const Eigen::Matrix<double, 6, 4> spread = factor.solve(closing.transpose());
        const Vector6 free = factor.solve(right);
        const Eigen::Matrix4d reduced = closing * spread;
        const Eigen::Vector4d multipliers = reduced.llt().solve(closing * free + drift);
        Eigen::Map<Vector6> speeds(out), accelerations(out + 6);
        speeds = v;
        accelerations = free - spread * multipliers;
    }
};
Peer peer;
}  // namespace

KT_RHS(const double *p, const double *x, double *out) {
    (void)p;
    peer.evaluate(x, out);
}
"""


def source() -> Source:
    """Return the peer as C++; its model is run-time data by nature.

    The headers come with the packages ``pin`` and, for Eigen, ``casadi``.
    """
    declarations = "\n".join(_declare(name, value) for name, value in numbers().items())
    options = [f"-I{folder}" for folder in _headers()]
    library = _prefix() / "lib"
    options += [f"-D{definition}" for definition in _DEFINITIONS]
    options += ["-std=c++17", f"-L{library}", f"-Wl,-rpath,{library}", "-lpinocchio_default"]
    code = _CODE.replace("NUMBERS", declarations)
    return Source("pinocchio", code, 12, 12, ACCELERATIONS, compiler="g++", options=tuple(options))


def state(instant: Instant) -> Array:
    """Return this model's state, shape (12,)."""
    tree = tree_state(instant)
    order = list(_ORDER)
    return np.concatenate((tree[:6][order], tree[6:][order]))


def accelerations(out: Array) -> Array:
    """Return the second derivatives of beta1 and spin from this model's output."""
    return out[[6, 11]]


def _declare(name: str, value: Array) -> str:
    if not value.ndim:
        return f"const double {name} = {float(value)!r};"
    elements = ", ".join(repr(float(element)) for element in value.ravel())
    if value.ndim == 2:
        return f"const Matrix3 {name} = (Matrix3() << {elements}).finished();"
    kind = "Vector3" if len(value) == 3 else "Eigen::Vector2d"
    return f"const {kind} {name}({elements});"


def _folder(package: str) -> Path:
    found = importlib.util.find_spec(package)
    if found is None or found.origin is None:
        message = f"{package} is not installed"
        raise ModuleNotFoundError(message)
    return Path(found.origin).parent


def _prefix() -> Path:
    import pinocchio  # noqa: PLC0415  # may not be installed

    for folder in Path(pinocchio.__file__).parents:
        if folder.name == "cmeel.prefix":
            return folder
    message = "pinocchio is not that of the package pin"
    raise ModuleNotFoundError(message)


def _headers() -> list[Path]:
    eigen = Path("/usr/include/eigen3")
    bundled = _folder("casadi") / "include" / "eigen3"
    return [_prefix() / "include", bundled if bundled.is_dir() else eigen]
