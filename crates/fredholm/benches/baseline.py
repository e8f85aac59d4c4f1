"""What NumPy and SciPy reach on Fredholm equations of the second kind: the baseline that `cargo bench` is set against.

φ(x) = f(x) + ∫ K(x, y) φ(y) dy, solved the way that it is usually written in Python: nodes and weights, one dense
matrix, `scipy.linalg.solve`, n doubled until two answers agree to the tolerance. For each class of kernel the method is one that
suits it, and everything that is computed for a rule is vectorised:

    smooth      Nyström with Clenshaw–Curtis
    periodic    Nyström with the trapezoid rule
    Green       Chebyshev collocation, the integral divided at y = x
    singular    quadratic product integration on a mesh graded towards both ends
    half-line   Nyström with Gauss–Legendre, mapped by y = (1 + t)/(1 − t)

Run:  python3 -m venv env && env/bin/pip install numpy scipy
      env/bin/python crates/fredholm/benches/baseline.py

A line is one problem: the largest error against the known solution at 200 points, relative to max |φ|; the n of the last
matrix; the median time of several solutions, all doublings included. Threads of the linear algebra are as they are set
(OPENBLAS_NUM_THREADS).
"""

import statistics
import time

import numpy as np
from scipy.linalg import solve
from scipy.special import spence

CHECKS = 200  # points at which two answers are compared
RUNS = 7
MOST = 2**11  # nodes


def clenshaw_curtis(n, a, b):
    """Nodes and weights of the rule with n + 1 Chebyshev points, n even."""
    angles = np.pi * np.arange(n + 1) / n
    moments = np.zeros(n + 1)
    moments[::2] = 2 / (1 - np.arange(0, n + 1, 2.0) ** 2)
    # The weights are the cosine transform of the moments.
    weights = np.fft.irfft(moments, 2 * n)[: n + 1] * 2
    weights[[0, -1]] /= 2
    middle, half = (a + b) / 2, (b - a) / 2
    return middle - half * np.cos(angles), half * weights


def doubled(solve_with, first, tolerance, checks):
    """(φ at the checks, n): `solve_with(n)` is a function, and n grows until it does not change any more."""
    n, before = first, None
    while True:
        phi = solve_with(n)(checks)
        change = np.inf if before is None else np.abs(phi - before).max() / np.abs(phi).max()
        if change <= tolerance or 2 * n > MOST:
            return phi, n
        before, n = phi, 2 * n


def nystrom(kernel, source, nodes, weights):
    """The function f + Σ_j K(·, x_j) w_j u_j."""
    matrix = np.eye(len(nodes)) - kernel(nodes[:, None], nodes) * weights
    weighted = weights * solve(matrix, source(nodes))
    return lambda x: source(x) + kernel(x[:, None], nodes) @ weighted


def smooth(problem, n):
    return nystrom(problem.kernel, problem.source, *clenshaw_curtis(n, *problem.interval))


def periodic(problem, n):
    a, b = problem.interval
    return nystrom(problem.kernel, problem.source, a + (b - a) * np.arange(n) / n, np.full(n, (b - a) / n))


def half_line(problem, n):
    t, w = np.polynomial.legendre.leggauss(n)
    return nystrom(problem.kernel, problem.source, (1 + t) / (1 - t), w * 2 / (1 - t) ** 2)


def interpolation(nodes, points):
    """The matrix that takes values at Chebyshev nodes to values at points (barycentric)."""
    signs = np.where(np.arange(len(nodes)) % 2, -1.0, 1.0)
    signs[[0, -1]] /= 2
    apart = points[..., None] - nodes
    hit = apart == 0
    terms = signs / np.where(hit, 1, apart)
    matrix = terms / terms.sum(-1, keepdims=True)
    return np.where(hit.any(-1, keepdims=True), hit, matrix)


def green(problem, n):
    """Collocation: ∫_a^x and ∫_x^b by rules of their own, on which the polynomial through the nodes is evaluated."""
    a, b = problem.interval
    nodes, _ = clenshaw_curtis(n, a, b)
    unit, w = clenshaw_curtis(n, 0, 1)

    def action(x):
        below, above = x[:, None] - a, b - x[:, None]
        y = np.hstack([a + below * unit, x[:, None] + above * unit])
        weights = np.hstack([below * w, above * w])
        return np.einsum("ik,ikj->ij", problem.kernel(x[:, None], y) * weights, interpolation(nodes, y))

    u = solve(np.eye(n + 1) - action(nodes), problem.source(nodes))
    return lambda x: problem.source(x) + action(x) @ u


def singular(problem, n):
    """φ ≈ a quadratic in each of n/2 panels, times the singularity integrated exactly."""
    a, b = problem.interval
    t = np.arange(n // 2 + 1) / (n // 2)
    # Panels shrink like t⁴ at both ends: solutions such as x ln x are then as good as smooth ones.
    half = np.where(t < 0.5, (2 * t) ** 4, (2 - 2 * t) ** 4) / 2
    ends = a + (b - a) * np.where(t < 0.5, half, 1 - half)
    width = np.diff(ends)
    nodes = np.sort(np.concatenate([ends, (ends[1:] + ends[:-1]) / 2]))
    gauss, gauss_weights = np.polynomial.legendre.leggauss(12)

    def panel_weights(x):
        """∫ K(x, y) ℓ_k(y) dy on every panel for its three quadratics ℓ_k: [x, panel, k]."""
        middle = (ends[1:] + ends[:-1]) / 2
        y = middle + gauss[:, None] * width / 2  # [gauss, panel]
        basis = np.stack([gauss * (gauss - 1) / 2, 1 - gauss**2, gauss * (gauss + 1) / 2])
        offset = y - x[:, None, None]
        far = problem.singularity(np.where(offset == 0, 1, offset)) * (gauss_weights[:, None] * width / 2)
        weights = np.einsum("kg,igp->ipk", basis, far)
        near = np.abs(middle - x[:, None]) < 1.5 * width
        i, p = np.nonzero(near)
        left, right = ends[p] - x[i], ends[p + 1] - x[i]
        moments = [problem.moment(k, right) - problem.moment(k, left) for k in range(3)]
        # With s = 2(y − middle)/width the quadratics are (s² − s)/2, 1 − s², (s² + s)/2.
        h, c = width[p] / 2, middle[p] - x[i]
        s1 = (moments[1] - c * moments[0]) / h
        s2 = (moments[2] - 2 * c * moments[1] + c * c * moments[0]) / h**2
        weights[i, p] = np.stack([(s2 - s1) / 2, moments[0] - s2, (s2 + s1) / 2], axis=-1)
        return weights

    def action(x):
        weights = panel_weights(x)
        matrix = np.zeros((len(x), n + 1))
        matrix[:, 1::2] = weights[:, :, 1]
        matrix[:, :-1:2] += weights[:, :, 0]
        matrix[:, 2::2] += weights[:, :, 2]
        return matrix

    u = solve(np.eye(n + 1) - action(nodes), problem.source(nodes))
    return lambda x: problem.source(x) + action(x) @ u


class Problem:
    """An equation with its solution; a singular one has K(x, y) = singularity(y − x) and its `moment`s."""

    def __init__(self, name, method, first, tolerance, interval, source, exact, kernel=None, singularity=None, moment=None):
        self.name, self.method, self.first, self.tolerance = name, method, first, tolerance
        self.interval, self.source, self.exact = interval, source, exact
        self.kernel, self.singularity, self.moment = kernel, singularity, moment

    def checks(self):
        a, b = self.interval
        t = (np.arange(CHECKS) + 0.5) / CHECKS
        return a + (b - a) * t if np.isfinite(b) else a + t / (1 - t)


def log_moment(k, u):
    """∫ u^k ln|u| du."""
    size = np.where(u == 0, 1, np.abs(u))
    return u ** (k + 1) * (np.log(size) / (k + 1) - 1 / (k + 1) ** 2)


def x_ln(x):
    return x * np.log(np.where(x == 0, 1, x))


def power_moment(alpha, scale):
    """∫ scale u^k |u|^α du."""
    return lambda k, u: scale * u**k * np.sign(u) * np.abs(u) ** (1 + alpha) / (k + 1 + alpha)


def s04(x, c=0.01):
    z1 = np.log((c * c + (1 - x) ** 2) / (c * c + x * x))
    z2 = np.arctan((1 - x) / c) + np.arctan(x / c)
    phi = 0.06 - 0.8 * x + x * x
    return phi - (c + c * (x - 0.4) * z1 + (phi - c * c) * z2) / 5


def d01(x):
    phi = np.exp(-x) * np.sin(x)
    return phi - (x * (1 - np.cos(1) / np.e) - 1 + np.cos(x) * np.exp(-x)) / 2


def l04(x):
    x_ = np.where(x == 0, 1, x)
    # scipy's spence(z) is Li₂(1 − z).
    li2 = np.pi**2 / 3 - np.log(x_) ** 2 / 2 - spence(1 - x)
    integral = -(1 + x) * x_ln(1 - x) / 4 - (-0.25 - x + x * x * li2) / 2 + (0.5 + x - x * x_ln(x)) / 4
    return x_ln(x) - integral


def a02(x):
    left = x ** (8 / 3) * (54 * x * x - 126 * x + 77)
    right = (1 - x) ** (8 / 3) * (54 * x * x + 18 * x + 5)
    return x**2 * (1 - x) ** 2 - 27 / 30800 * (left + right)


def i01(x):
    q = np.sqrt(1 + x * x)
    return 1 / (1 + x * x) - np.pi / 2 / (q * (1 + q))


UNIT = (0.0, 1.0)

PROBLEMS = [
    Problem(
        "S01", smooth, 8, 1e-14, UNIT,
        lambda x: np.exp(-x) - 0.5 + np.exp(-(x + 1)) / 2,
        lambda x: np.exp(-x),
        lambda x, y: (x + 1) * np.exp(-x * y) / 2,
    ),
    Problem(
        "S04 c=.01", smooth, 8, 1e-12, UNIT, s04,
        lambda x: 0.06 - 0.8 * x + x * x,
        lambda x, y: 0.01 / 5 / (1e-4 + (x - y) ** 2),
    ),
    Problem(
        "S06", periodic, 8, 1e-13, (-np.pi, np.pi),
        lambda x: 25 - 16 * np.sin(x) ** 2,
        lambda x: 17 / 2 + 128 / 17 * np.cos(2 * x),
        lambda x, y: -0.3 / np.pi / (1 - 0.64 * np.cos((x + y) / 2) ** 2),
    ),
    Problem(
        "D01", green, 8, 1e-12, UNIT, d01,
        lambda x: np.exp(-x) * np.sin(x),
        lambda x, y: -np.minimum(x, y) * (1 - np.maximum(x, y)),
    ),
    Problem(
        "D04", green, 8, 1e-12, UNIT,
        lambda x: (1 - 1 / np.pi**2) * np.sin(np.pi * x),
        lambda x: np.sin(np.pi * x),
        lambda x, y: np.minimum(x, y) * (1 - np.maximum(x, y)),
    ),
    Problem(
        "L04", singular, 16, 1e-11, UNIT, l04, x_ln,
        singularity=lambda u: np.log(np.abs(u)), moment=log_moment,
    ),
    Problem(
        "A02", singular, 16, 1e-11, UNIT, a02,
        lambda x: x**2 * (1 - x) ** 2,
        singularity=lambda u: np.abs(u) ** (-1 / 3) / 10, moment=power_moment(-1 / 3, 0.1),
    ),
    Problem(
        "I01", half_line, 8, 1e-11, (0.0, np.inf), i01,
        lambda x: 1 / (1 + x * x),
        lambda x, y: 1 / (1 + x * x + y * y),
    ),
]


def line(problem):
    """The row of the table for a problem."""
    checks = problem.checks()
    times = []
    while len(times) < RUNS and sum(times) < 20:
        start = time.perf_counter()
        phi, n = doubled(lambda n: problem.method(problem, n), problem.first, problem.tolerance, checks)
        times.append(time.perf_counter() - start)
    exact = problem.exact(checks)
    error = np.abs(phi - exact).max() / np.abs(exact).max()
    milliseconds = 1000 * statistics.median(times)
    return f"{problem.name:10}  {problem.method.__name__:9}  {problem.tolerance:9.0e}  {error:8.1e}  {n:5}  {milliseconds:9.2f}"


if __name__ == "__main__":
    print("problem     method     tolerance     error      n         ms")
    for problem in PROBLEMS:
        print(line(problem), flush=True)
