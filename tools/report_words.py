"""How numbers and lists look on the page."""

PART_NAMES = {"final": "all light", "direct": "direct", "indirect_diffuse": "indirect diffuse",
              "indirect_specular": "indirect specular"}
NOISY = "†"  # behind an error whose reference has noise above a tenth of it


def ms(value):
    return f"{value:.0f} ms" if value >= 100 else f"{value:.1f} ms"


def share(value):
    """An error, or nothing where there is none."""
    return "-" if value is None else f"{value:.3f}" if abs(value) < 9.9995 else f"{value:.3g}"


def marked(measures):
    """SMAPE, with a mark where the reference's noise is a part of it."""
    return share(measures["smape"]) + NOISY * bool(measures["noisy"])


def factor(value):
    return f"{value:.2f}" if value < 9.995 else f"{value:.3g}"


def megabytes(value):
    return f"{value / 1e6:.0f} MB"


def code(setting):
    return "the baseline" if setting == "baseline" else f"`{setting}`"


def joined(words):
    words = list(words)
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(["", *lines, *("| " + " | ".join(map(str, row)) + " |" for row in rows), ""])
