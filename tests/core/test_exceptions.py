"""Errors carry facts, say them once, and cross process borders."""

import pickle

import pytest

from linkforge_compile.core.exceptions import (
    LinkForgeError,
    RobotGeneratorError,
    RobotGeneratorUnsupportedTypeError,
    RobotMathError,
    RobotModelError,
    RobotParserError,
    RobotParserIOError,
    RobotParserUnexpectedError,
    RobotParserXMLRootError,
    RobotPhysicsError,
    RobotSecurityError,
    RobotValidationError,
    RobotXacroError,
    RobotXacroExpressionError,
    RobotXacroRecursionError,
    ValidationErrorCode,
    XacroDetectedError,
)

CODED = {RobotValidationError: "", RobotPhysicsError: "PHYSICS_", RobotMathError: "MATH_"}


@pytest.mark.parametrize("kind", CODED)
def test_the_text_is_code_message_target_value(kind):
    error = kind(ValidationErrorCode.OUT_OF_RANGE, "too much", "Mass", 7)
    assert str(error) == f"[{CODED[kind]}OUT_OF_RANGE] too much (target: Mass) (value: 7)"
    assert (error.code, error.message, error.target, error.value, error.field) == (
        ValidationErrorCode.OUT_OF_RANGE,
        "too much",
        "Mass",
        7,
        (),
    )


def test_target_and_value_are_left_out_where_there_are_none_but_zero_is_a_value():
    assert str(RobotValidationError(ValidationErrorCode.NO_ROOT, "no root")) == "[NO_ROOT] no root"
    assert str(RobotValidationError(ValidationErrorCode.NO_ROOT, "no root", value=0)) == "[NO_ROOT] no root (value: 0)"


def test_a_plain_model_error_accepts_a_sentence_as_any_exception_does():
    error = RobotModelError("no such arm")
    assert str(error) == error.message == "no such arm"
    assert error.code is ValidationErrorCode.GENERIC_FAILURE
    assert error.field == ()


def test_the_tree_is_that_of_linkforge():
    for kind in (*CODED, RobotSecurityError):
        assert kind.__mro__[-4:-3] == (LinkForgeError,)
        assert issubclass(kind, RobotModelError)
        assert not any(issubclass(kind, other) for other in CODED if other is not kind)
    assert issubclass(RobotGeneratorUnsupportedTypeError, RobotGeneratorError)
    for kind in (RobotParserIOError, RobotParserXMLRootError, RobotParserUnexpectedError, RobotXacroError):
        assert issubclass(kind, RobotParserError)
    for kind in (RobotXacroRecursionError, RobotXacroExpressionError):
        assert issubclass(kind, RobotXacroError)
    assert issubclass(XacroDetectedError, RobotParserError)
    assert not issubclass(XacroDetectedError, RobotXacroError)


def test_there_are_twenty_codes_and_each_is_its_own_name_in_lower_case():
    assert len(ValidationErrorCode) == 20
    assert all(code.value == code.name.lower() for code in ValidationErrorCode)


@pytest.mark.parametrize(
    "error",
    [
        RobotValidationError(ValidationErrorCode.NOT_FOUND, "no link", "Link", ("a", 1), field=("joints", "elbow")),
        RobotModelError("no such arm"),
        RobotSecurityError("/etc", "outside of the package"),
        RobotGeneratorUnsupportedTypeError("soup", "urdf"),
        RobotParserIOError("arm.urdf", "gone"),
        RobotParserXMLRootError("sdf"),
        RobotParserUnexpectedError("links", "boom"),
        RobotXacroError("no macro", "line 3"),
        RobotXacroRecursionError(99, "a includes a"),
        RobotXacroExpressionError("1/0", "division by zero"),
        XacroDetectedError(),
    ],
    ids=lambda error: type(error).__name__,
)
def test_errors_come_back_whole_from_another_process(error):
    back = pickle.loads(pickle.dumps(error))
    assert type(back) is type(error)
    assert str(back) == str(error)
    assert vars(back) == vars(error)
