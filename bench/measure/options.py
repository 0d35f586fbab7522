"""Options that several benchmarks have."""


def add_benchmark(subcommands, common, name, summary, part):
    """The parser of a subcommand. `part` measures it."""
    parser = subcommands.add_parser(name, parents=[common], help=summary)
    parser.set_defaults(parts=[part])
    return parser


def add_count(parser, name, default, what, least=1):
    """A number of rounds or samples; smaller ones than `least` become `least`."""
    parser.add_argument(
        name,
        type=lambda text: max(least, int(text)),
        default=default,
        metavar="N",
        help=f"{what} (default: {default})",
    )


def add_size(parser, default, what="of the picture"):
    parser.add_argument(
        "--size", metavar="WxH", default=default, help=f"{what} (default: {default})"
    )
