"""How a map shows itself in a notebook."""
import html

from ._core import TextMap


def text_map_html(self: TextMap) -> str:
    """A table of the texts of a map."""
    head = "<tr><th>id</th><th>word</th><th>state</th><th>host</th><th>views</th><th>ZNCC</th></tr>"
    rows = "".join(
        f"<tr><td>{text.id}</td><td>{html.escape(text.word)}</td><td>{text.state.name}</td><td>{text.host}</td>"
        f"<td>{len(text.views)}</td><td>{text.zncc:.3f}</td></tr>" for text in self.objects())
    return f"<table>{head}{rows}</table>"
