"""The stored messages are those of tests that there are."""

import pytest
from support import messages


def test_every_message_is_of_a_test(request):
    """Of the files that are run; of a part of a file, nothing is known.

    ``--update-messages`` removes those of other tests.
    """
    if request.config.option.keyword:
        pytest.skip("a part of the tests")
    whole = {item.path.stem for item in request.session.items}
    names = {messages.key_of(item) for item in request.session.items}
    others = {key for key in messages.stored() if key.partition("::")[0] in whole} - names
    if request.config.option.update_messages:
        for key in others:
            del messages.stored()[key]
        messages.write()
    else:
        assert not others, "if on purpose: pytest --update-messages"
