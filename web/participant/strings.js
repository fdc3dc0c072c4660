// Every text of the interface in every language. Texts of a study come from the server.
// Near pictures no digit may be: places on the scale are named in words.

const english_ordinals = ["first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth",
  "ninth", "tenth", "eleventh", "twelfth"];
const dutch_ordinals = ["eerste", "tweede", "derde", "vierde", "vijfde", "zesde", "zevende", "achtste",
  "negende", "tiende", "elfde", "twaalfde"];

export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/// Counted from the nearer end, so that few words reach every shelf of a long scale.
function shelf_name(shelf, count, ordinals, words) {
  if (shelf === 0) return words.top;
  if (shelf === count - 1) return words.bottom;
  const from_top = shelf < count / 2;
  const steps = from_top ? shelf : count - 1 - shelf;
  return words.between(ordinals[steps] ?? words.far, from_top);
}

/// A view of a page that can be turned, counted from the one in the middle.
function view_name(steps, ordinals, words) {
  return steps === 0 ? words.middle : words.aside(ordinals[Math.abs(steps) - 1] ?? words.far, steps < 0);
}

const en = {
  language: "English",
  choose_language: "Language",
  loading: "One moment…",
  start: "I agree and want to take part",
  consent_heading: "Taking part",
  over_heading: "This survey is over",
  over_kept: (answered, pages) => (answered === 0
    ? "It was closed before you answered a page. Nothing about your answers is kept."
    : `It was closed before you finished. Your answers to ${answered} of ${pages} pages are kept and may be used. With the code below you can have them deleted.`),
  screened_out: "Your answers, or your screen, do not fit what this survey needs, so it ends here. What you answered is kept, marked as such; with your withdrawal code you can have it deleted.",
  closes: (time) => `This survey has been closed. You can finish until ${time.toLocaleString("en")}.`,
  preview: "Preview: not counted",
  no_study: "There is no survey at this address. Please check the link.",
  unreachable: "The server cannot be reached. Please check your connection.",
  try_again: "Try again",
  phone: "Please open this survey on a tablet or computer: its pictures need a larger screen.",
  window: (width, height) =>
    `Please make this window larger: the pictures need at least ${width} by ${height}.`,
  how_heading: "How it works",
  how_look: ["Look", "On each page you see several pictures of one scene."],
  how_closer: ["Look closer", "Enlarge a picture, or flip between two of them in the same place."],
  how_shelves: (most, least) => ["Order", `Put every picture on a shelf, from “${most}” at the top to ` +
    `“${least}” at the bottom. Pictures that you hold to be equal in this go on the same shelf. ` +
    "Shelves may stay empty."],
  how_digits: (one, nine) => ["Rank", `Give every picture a digit, from 1 for “${one}” to 9 for “${nine}”. ` +
    "Pictures that you hold to be equal in this get the same digit. Not every digit has to be used."],
  digits_scale: (one, nine) => `1 is “${one}”, 9 is “${nine}”. Equal digits are allowed.`,
  how_ways: "Drag a picture to its shelf, or choose it and then choose the shelf. On a keyboard, N " +
    "goes to the next picture to place and, when none is left, to the question below; the up and down arrows move the picture in focus, " +
    "Home, M and End move it to the top, the middle and the bottom, the left and right arrows go to its neighbours, " +
    "Delete takes it back and E enlarges it, as a double click does.",
  turn: "Turn the view",
  turn_keys: "comma, full stop turn the view",
  view: (steps) => view_name(steps, english_ordinals, {
    middle: "middle", far: "far", aside: (which, to_left) => `${which} view to the ${to_left ? "left" : "right"}` }),
  board_keys: "N next · ↑ ↓ move · Home M End top, middle, bottom · E enlarge · Delete back",
  screen_heading: "Check your screen",
  screen_text: "Parts of the pictures are dark. If you cannot tell the patches apart, turn your screen brighter or move away from bright light.",
  screen_patches: "A row of dark grey patches, each a little lighter than the one before",
  patches_seen: "How many patches can you tell apart?",
  demographics_heading: "About you",
  optional: "optional",
  no_answer: "I would rather not say",
  begin: "Show the first page",
  pictures_loading: "Loading the pictures…",
  pictures_loaded: (done, total) => `${done} of ${total}`,
  pictures_failed: "Not every picture could be loaded. Nothing is lost; please try again.",
  page_of: (page, count) => `Page ${page} of ${count}`,
  practice: "Practice page",
  practice_text: "This page is for practice. It does not count.",
  practice_right: "That is the order that is meant",
  practice_wrong: "Another order is meant",
  practice_meant: (most, least) => `From “${most}” to “${least}”:`,
  practice_survey: "This page does not count. On the pages that follow no order is right or wrong: what counts is what you see.",
  practice_again: "Practise again",
  kept_heading: "Exactly what is kept",
  kept: (parameters) => [
    "your answers, also those that you change, and the order in which pages and pictures were shown;",
    "when you entered, answered each page and finished, and how long you looked at each page;",
    "how often you enlarged or compared pictures, turned an order round, left the window, and how often a picture failed to load;",
    "the size of your window and screen, how fine its pixels are, and how many dark patches you told apart;",
    "the language you chose, the version of this text, and what you tell about yourself at the end, if you are asked.",
    ...(parameters.length ? [`From the link that brought you here, if it holds them: ${parameters.join(", ")}. ` +
      "The site that sent you knows who that is; nothing else does."] : []),
  ],
  tray: "Pictures to place",
  tray_empty: "Every picture is on a shelf.",
  tray_back: "Back among the pictures to place",
  reference: "The true picture, for comparison",
  reference_short: "true",
  shelves: "Shelves",
  picture: (letter) => `Picture ${letter}`,
  shelf: (shelf, count, most, least) => shelf_name(shelf, count, english_ordinals, {
    top: most ? `top shelf, ${most}` : "top shelf",
    bottom: least ? `bottom shelf, ${least}` : "bottom shelf",
    far: "middle",
    between: (word, from_top) => `${word} shelf from the ${from_top ? "top" : "bottom"}`,
  }),
  unplaced: "not placed yet",
  picked: (picture) => `${picture} chosen. Now choose a shelf.`,
  released: (picture) => `${picture} no longer chosen.`,
  moved: (picture, shelf, others) =>
    `${picture}: ${shelf}${others.length ? `, together with ${others.join(", ")}` : ""}.`,
  taken_back: (picture) => `${picture}: back among the pictures to place.`,
  at_end: (picture, shelf) => `${picture} is already on the ${shelf}.`,
  put_here: "Put it here",
  shelf_holds: (shelf, pictures) => `${capital(shelf)}: ${pictures.length ? pictures.join(", ") : "empty"}`,
  pick_first: "Choose a picture first, then a shelf.",
  all_same: "They all look the same to me",
  enlarge: (picture) => `Enlarge ${picture}`,
  difficulty_missing: "Please say how hard it was to see a difference.",
  unplaced_missing: (names, all) => (names.length === all ? "No picture is on a shelf yet."
    : `Not on a shelf yet: ${names.join(", ")}.`),
  digits_missing: (names) => `Please give a digit to ${names.join(", ")}.`,
  missing_heading: "Something is missing",
  next: "Continue",
  back: "Back",
  confirm_heading: "Is this right?",
  confirm_same: "You say that all pictures look the same.",
  confirm_yes: "Yes, continue",
  confirm_swap: "It is the other way round",
  confirm_no: "No, go back",
  swapped: "The order is turned round. Please look again.",
  viewer: "Pictures in actual size",
  viewer_hint: "Choose two pictures below and flip between them, or set them side by side.",
  viewer_keys: "Keys: Page Up, Page Down other picture · Space flip · S side by side · + − zoom · arrows look around · Esc close",
  beside: "Side by side",
  at: (picture, place) => (place ? `${picture}: ${place}` : picture),
  flip: "Flip",
  flip_with: (picture) => `Flip to ${picture}`,
  closer: "Zoom in",
  further: "Zoom out",
  close: "Close",
  shown_now: (picture) => `${picture} is shown`,
  saved: "Saved",
  sending: "Saving…",
  waiting: "No connection. Your answers are kept on this device and are sent as soon as possible.",
  waiting_short: "Kept on this device",
  refused: (reason) => `An answer could not be stored. ${reason}`,
  errors: {
    bad_value: "Something that was sent is not as the survey expects it.",
    unauthorized: "This needs the researcher's access.",
    forbidden: "This is not allowed here.",
    not_found: "There is nothing at this address.",
    conflict: "This does not fit what was stored before.",
    "conflict answer_id": "Another answer was stored under this number.",
    "conflict participant": "This survey was completed already.",
    "conflict quota": "This survey takes no more participants. Thank you for coming.",
    "conflict study": "This survey is not open at the moment.",
    too_large: "What was sent is too large.",
    otherwise: "The server cannot do this.",
  },
  finishing: "Sending your last answers…",
  end_heading: "You have finished",
  completion: "Your completion code",
  completion_link: "Return to the site that sent you",
  withdrawal: "Your withdrawal code",
  withdrawal_text: "Keep it if you may want your answers deleted later. With this code, and only with it, they can be found.",
  copy: "Copy",
  copied: "Copied",
  withdraw_heading: "Delete answers",
  withdraw_text: "Enter a withdrawal code. All answers given under it are deleted for good.",
  withdraw_code: "Withdrawal code",
  withdraw: "Delete all answers",
  withdrawn: "All answers given under this code are deleted.",
  withdraw_unknown: "No answers belong to this code. Please check it.",
  gone: "Your answers have been deleted, or this survey has been closed.",
  digit: (picture) => `Digit for ${picture}`,
};

const nl = {
  language: "Nederlands",
  choose_language: "Taal",
  loading: "Een ogenblik…",
  start: "Ik ga akkoord en doe mee",
  consent_heading: "Meedoen",
  over_heading: "Deze enquête is voorbij",
  over_kept: (answered, pages) => (answered === 0
    ? "Ze werd gesloten voordat u een pagina had beantwoord. Van uw antwoorden is niets bewaard."
    : `Ze werd gesloten voordat u klaar was. Uw antwoorden op ${answered} van ${pages} pagina's zijn bewaard en kunnen worden gebruikt. Met de code hieronder kunt u ze laten wissen.`),
  screened_out: "Uw antwoorden, of uw scherm, passen niet bij wat deze enquête nodig heeft. Daarom eindigt ze hier. Wat u hebt geantwoord, is bewaard en gemarkeerd; met uw intrekkingscode kunt u het laten wissen.",
  closes: (time) => `Deze enquête is gesloten. U kunt haar afmaken tot ${time.toLocaleString("nl")}.`,
  preview: "Voorbeeld: telt niet mee",
  no_study: "Op dit adres is geen onderzoek. Controleer de link.",
  unreachable: "De server is niet bereikbaar. Controleer uw verbinding.",
  try_again: "Opnieuw proberen",
  phone: "Open dit onderzoek op een tablet of computer: de plaatjes vragen een groter scherm.",
  window: (width, height) =>
    `Maak dit venster groter: de plaatjes vragen minstens ${width} bij ${height}.`,
  how_heading: "Zo werkt het",
  how_look: ["Kijken", "Op elke pagina ziet u een aantal plaatjes van één scène."],
  how_closer: ["Beter kijken", "Vergroot een plaatje, of wissel er twee af op dezelfde plek."],
  how_shelves: (most, least) => ["Ordenen", `Zet elk plaatje op een plank, van “${most}” bovenaan tot ` +
    `“${least}” onderaan. Plaatjes die u hierin gelijk vindt, gaan op dezelfde plank. ` +
    "Planken mogen leeg blijven."],
  how_digits: (one, nine) => ["Rangschikken", `Geef elk plaatje een cijfer, van 1 voor “${one}” tot 9 voor ` +
    `“${nine}”. Plaatjes die u hierin gelijk vindt, krijgen hetzelfde cijfer. ` +
    "U hoeft niet elk cijfer te gebruiken."],
  digits_scale: (one, nine) => `1 is “${one}”, 9 is “${nine}”. Gelijke cijfers mogen.`,
  how_ways: "Sleep een plaatje naar zijn plank, of kies eerst het plaatje en dan de plank. Met het toetsenbord " +
    "gaat N naar het volgende te plaatsen plaatje en, als er geen meer is, naar de vraag eronder; de pijlen omhoog en omlaag verplaatsen het plaatje, " +
    "Home, M en End zetten het bovenaan, in het midden en onderaan, de pijlen links en rechts gaan naar de buren, " +
    "Delete haalt het terug en E vergroot het, net als dubbelklikken.",
  turn: "Draai het beeld",
  turn_keys: "komma, punt draaien het beeld",
  view: (steps) => view_name(steps, dutch_ordinals, {
    middle: "midden", far: "verste", aside: (which, to_left) => `${which} blik naar ${to_left ? "links" : "rechts"}` }),
  board_keys: "N volgende · ↑ ↓ schuiven · Home M End boven, midden, onder · E vergroot · Delete terug",
  screen_heading: "Controleer uw scherm",
  screen_text: "Delen van de plaatjes zijn donker. Kunt u de vlakjes niet uit elkaar houden, zet uw scherm dan helderder of ga uit het felle licht.",
  screen_patches: "Een rij donkergrijze vlakjes, elk iets lichter dan het vorige",
  patches_seen: "Hoeveel vlakjes kunt u onderscheiden?",
  demographics_heading: "Over u",
  optional: "niet verplicht",
  no_answer: "Dat zeg ik liever niet",
  begin: "Toon de eerste pagina",
  pictures_loading: "De plaatjes worden geladen…",
  pictures_loaded: (done, total) => `${done} van ${total}`,
  pictures_failed: "Niet elk plaatje kon worden geladen. Er is niets verloren; probeer het opnieuw.",
  page_of: (page, count) => `Pagina ${page} van ${count}`,
  practice: "Oefenpagina",
  practice_text: "Deze pagina is om te oefenen. Ze telt niet mee.",
  practice_right: "Dat is de bedoelde volgorde",
  practice_wrong: "Een andere volgorde is bedoeld",
  practice_meant: (most, least) => `Van “${most}” naar “${least}”:`,
  practice_survey: "Deze pagina telt niet mee. Op de volgende pagina's is geen volgorde goed of fout: het gaat om wat u ziet.",
  practice_again: "Nog eens oefenen",
  kept_heading: "Wat er precies wordt bewaard",
  kept: (parameters) => [
    "uw antwoorden, ook die u verandert, en de volgorde waarin pagina's en afbeeldingen werden getoond;",
    "wanneer u begon, elke pagina beantwoordde en klaar was, en hoe lang u naar elke pagina keek;",
    "hoe vaak u afbeeldingen vergrootte of vergeleek, een volgorde omdraaide of het venster verliet, en hoe vaak een afbeelding niet laadde;",
    "de grootte van uw venster en scherm, hoe fijn de beeldpunten zijn, en hoeveel donkere vlakjes u onderscheidde;",
    "de gekozen taal, de versie van deze tekst, en wat u aan het eind over uzelf vertelt, als daarnaar wordt gevraagd.",
    ...(parameters.length ? [`Uit de link die u hier bracht, als die ze bevat: ${parameters.join(", ")}. ` +
      "De site die u stuurde, weet wie dat is; niets anders weet het."] : []),
  ],
  tray: "Nog te plaatsen",
  tray_empty: "Elk plaatje staat op een plank.",
  tray_back: "Terug bij de te plaatsen plaatjes",
  reference: "Het ware plaatje, ter vergelijking",
  reference_short: "waar",
  shelves: "Planken",
  picture: (letter) => `Plaatje ${letter}`,
  shelf: (shelf, count, most, least) => shelf_name(shelf, count, dutch_ordinals, {
    top: most ? `bovenste plank, ${most}` : "bovenste plank",
    bottom: least ? `onderste plank, ${least}` : "onderste plank",
    far: "middelste",
    between: (word, from_top) => `${word} plank van ${from_top ? "boven" : "onderen"}`,
  }),
  unplaced: "nog niet geplaatst",
  picked: (picture) => `${picture} gekozen. Kies nu een plank.`,
  released: (picture) => `${picture} niet meer gekozen.`,
  moved: (picture, shelf, others) =>
    `${picture}: ${shelf}${others.length ? `, samen met ${others.join(", ")}` : ""}.`,
  taken_back: (picture) => `${picture}: terug bij de te plaatsen plaatjes.`,
  at_end: (picture, shelf) => `${picture} staat al op de ${shelf}.`,
  put_here: "Zet het hier",
  shelf_holds: (shelf, pictures) => `${capital(shelf)}: ${pictures.length ? pictures.join(", ") : "leeg"}`,
  pick_first: "Kies eerst een plaatje, dan een plank.",
  all_same: "Ze zien er voor mij allemaal hetzelfde uit",
  enlarge: (picture) => `Vergroot ${picture}`,
  difficulty_missing: "Geef aan hoe moeilijk het was om verschil te zien.",
  unplaced_missing: (names, all) => (names.length === all ? "Er staat nog geen plaatje op een plank."
    : `Nog niet op een plank: ${names.join(", ")}.`),
  digits_missing: (names) => `Geef een cijfer aan ${names.join(", ")}.`,
  missing_heading: "Er ontbreekt iets",
  next: "Verder",
  back: "Terug",
  confirm_heading: "Klopt dit?",
  confirm_same: "U zegt dat alle plaatjes er hetzelfde uitzien.",
  confirm_yes: "Ja, verder",
  confirm_swap: "Het is andersom",
  confirm_no: "Nee, terug",
  swapped: "De volgorde is omgedraaid. Kijk nog eens.",
  viewer: "Plaatjes op ware grootte",
  viewer_hint: "Kies hieronder twee plaatjes en wissel ze af, of zet ze naast elkaar.",
  viewer_keys: "Toetsen: Page Up, Page Down ander plaatje · spatie wisselen · S naast elkaar · + − zoomen · pijlen rondkijken · Esc sluiten",
  beside: "Naast elkaar",
  at: (picture, place) => (place ? `${picture}: ${place}` : picture),
  flip: "Wisselen",
  flip_with: (picture) => `Wissel naar ${picture}`,
  closer: "Inzoomen",
  further: "Uitzoomen",
  close: "Sluiten",
  shown_now: (picture) => `${picture} is te zien`,
  saved: "Opgeslagen",
  sending: "Opslaan…",
  waiting: "Geen verbinding. Uw antwoorden blijven op dit apparaat en worden zo snel mogelijk verstuurd.",
  waiting_short: "Op dit apparaat bewaard",
  refused: (reason) => `Een antwoord kon niet worden opgeslagen. ${reason}`,
  errors: {
    bad_value: "Iets wat is verstuurd, is niet zoals het onderzoek het verwacht.",
    unauthorized: "Hiervoor is de toegang van de onderzoeker nodig.",
    forbidden: "Dit mag hier niet.",
    not_found: "Op dit adres is niets.",
    conflict: "Dit past niet bij wat eerder is opgeslagen.",
    "conflict answer_id": "Onder dit nummer is een ander antwoord opgeslagen.",
    "conflict participant": "Dit onderzoek was al afgerond.",
    "conflict quota": "Dit onderzoek neemt geen deelnemers meer aan. Dank voor uw komst.",
    "conflict study": "Dit onderzoek is op dit moment niet open.",
    too_large: "Wat is verstuurd, is te groot.",
    otherwise: "De server kan dit niet doen.",
  },
  finishing: "Uw laatste antwoorden worden verstuurd…",
  end_heading: "U bent klaar",
  completion: "Uw voltooiingscode",
  completion_link: "Terug naar de site waar u vandaan kwam",
  withdrawal: "Uw intrekkingscode",
  withdrawal_text: "Bewaar deze als u uw antwoorden later misschien wilt laten wissen. Met deze code, en alleen daarmee, zijn ze te vinden.",
  copy: "Kopiëren",
  copied: "Gekopieerd",
  withdraw_heading: "Antwoorden wissen",
  withdraw_text: "Vul een intrekkingscode in. Alle antwoorden onder die code worden voorgoed gewist.",
  withdraw_code: "Intrekkingscode",
  withdraw: "Wis alle antwoorden",
  withdrawn: "Alle antwoorden onder deze code zijn gewist.",
  withdraw_unknown: "Bij deze code horen geen antwoorden. Controleer de code.",
  gone: "Uw antwoorden zijn gewist, of dit onderzoek is gesloten.",
  digit: (picture) => `Cijfer voor ${picture}`,
};

export const languages = { en, nl };

/// What a failed call means, in the participant's language: by code and field of the server's error,
/// whose own message is English and written for researchers.
export function reason_of(error, strings) {
  if (error.passing) return strings.unreachable;
  return strings.errors[`${error.code} ${error.field}`] ?? strings.errors[error.code] ?? strings.errors.otherwise;
}

/// Texts of a language; a study in another one keeps its own texts and gets English around them.
export const strings_of = (language) => languages[language] ?? en;
